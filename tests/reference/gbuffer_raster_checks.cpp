// SPDX-License-Identifier: MIT
#include "tests/reference/gbuffer_raster_checks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <random>

#include "host/gbuffer/raster.h"
#include "tests/reference/gbuffer_raster64_ref.h"
#include "tests/reference/gbuffer_raster_ref.h"
#include "tests/reference/gbuffer_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using runtime::Buffer;
template <typename... Extra>
using Kernels = gbuffer::RasterKernels<Buffer<shared::Material>, Buffer<float>,
                                       Buffer<std::uint32_t>, Buffer<std::uint32_t>, Extra...>;
using Words = Buffer<std::uint32_t>;

/// What the kernels leave per pixel.
struct RasterImage {
    int width = 0, height = 0;
    std::vector<float> depths;
    std::vector<int> triangles;  ///< -1: none
};

/// How an image differs from the twin.
struct RasterDifference {
    int wrong = 0;    ///< pixels whose triangle cannot be the nearest, whatever snapping does
    int decided = 0;  ///< pixels where snapping, or an alpha at its threshold, chose another one
    int covered = 0;  ///< by any triangle, according to the twin
};

shared::RasterView viewOf(const scene::CameraFrame& camera, int width, int height) {
    auto view = scene::rasterView(camera, glm::dvec3(0), width, height);
    view.requireFlags = DRAW_ANY;
    view.cullBack = DRAW_SINGLE_SIDED;
    return view;
}

/// depth bits and ~triangle, per pixel
std::pair<std::vector<std::uint32_t>, std::vector<std::uint32_t>> run32(
    const shared::RasterView& view, const geometry::Mesh& m) {
    const auto pixels = static_cast<std::uint64_t>(view.width * view.height);
    Words depths(device(), "depths", pixels), ids(device(), "ids", pixels);
    Kernels<Words> depth(program("frame"), "gbuffer_depth");
    Kernels<Words, Words> id(program("frame"), "gbuffer_id");
    gbuffer::TileList tiles(device());
    do {
        depths.fill(0);
        ids.fill(0);
        tiles.clear();
        depth.launch(view, m, tiles, m.materials, m.uvs, m.colours, m.texels, depths);
        tiles.clear();
        id.launch(view, m, tiles, m.materials, m.uvs, m.colours, m.texels, depths, ids);
    } while (tiles.grew());
    return {depths.download(), ids.download()};
}

std::pair<std::vector<std::uint32_t>, std::vector<std::uint32_t>> run64(
    const shared::RasterView& view, const geometry::Mesh& m) {
    const auto pixels = static_cast<std::uint64_t>(view.width * view.height);
    Words visibility(device(), "visibility", 2 * pixels);
    Kernels<Words> kernels(program("atomic64"), "gbuffer_raster64");
    gbuffer::TileList tiles(device());
    do {
        visibility.fill(0);
        tiles.clear();
        kernels.launch(view, m, tiles, m.materials, m.uvs, m.colours, m.texels, visibility);
    } while (tiles.grew());
    const auto words = visibility.download();
    std::vector<std::uint32_t> depths, ids;
    for (std::size_t i = 0; i < pixels; ++i) {
        ids.push_back(words[2 * i]);
        depths.push_back(words[2 * i + 1]);
    }
    return {depths, ids};
}

RasterImage rasterise(RasterPath path, const scene::Scene& scene, const scene::CameraFrame& camera,
                      int width, int height) {
    geometry::Geometry geometry(program("frame"), scene, glm::dvec3(0));
    const auto& mesh = geometry.run(scene::poseAt(scene, {}, 0));
    const auto view = viewOf(camera, width, height);
    const auto [depths, ids] =
        path == RasterPath::atomics64 ? run64(view, mesh) : run32(view, mesh);
    RasterImage image{width, height, {}, {}};
    for (std::size_t i = 0; i < ids.size(); ++i) {
        image.depths.push_back(std::bit_cast<float>(depths[i]));
        image.triangles.push_back(ids[i] == 0 ? -1 : static_cast<int>(~ids[i]));
    }
    return image;
}

RasterDifference compareRaster(const RasterImage& image, const RasterReference& twin) {
    RasterDifference difference;
    for (int row = 0; row < image.height; ++row)
        for (int column = 0; column < image.width; ++column) {
            const auto fragments = twin.fragments(column, row);
            const auto at = static_cast<std::size_t>(row * image.width + column);
            const RasterFragment* mine = nullptr;
            double floor = 0;  // the depth that the nearest surface has at the least
            int best = -1;
            double bestDepth = 0;
            for (const auto& f : fragments) {
                if (f.triangle == image.triangles[at]) mine = &f;
                if (!f.doubtful) floor = std::max(floor, f.depth - f.slack);
                if (f.depth > bestDepth) best = f.triangle, bestDepth = f.depth;
            }
            difference.covered += best >= 0;
            if (mine == nullptr) {
                // Nothing is drawn: right where nothing certainly passes
                const bool allowed = image.triangles[at] < 0 && floor == 0;
                difference.wrong += !allowed;
                difference.decided += allowed && best >= 0;
                continue;
            }
            const bool depthFits = std::abs(image.depths[at] - mine->depth) <= mine->slack;
            difference.wrong += !depthFits || mine->depth + mine->slack < floor;
            difference.decided += image.triangles[at] != best;
        }
    return difference;
}

/// From fewer pixels than a work-group has to triangles of many tiles.
constexpr std::pair<int, int> kSizes[] = {{7, 5}, {33, 17}, {61, 37}, {131, 71}};

/// `share` of the pixels must be covered, so that there was something to compare.
void expectLikeTwin(const RasterImage& image, const RasterReference& twin, double share) {
    const auto difference = compareRaster(image, twin);
    const double pixels = image.width * image.height;
    // The comparison knows by how much snapping may move a depth; what it cannot know is a vertex
    // that float snaps to the other neighbour and that moves an edge over a centre: 1 in 2000
    EXPECT_LE(difference.wrong, pixels / 2000) << image.width << " x " << image.height;
    EXPECT_LE(difference.decided, pixels / 50 + 2) << image.width << " x " << image.height;
    EXPECT_GT(difference.covered, share * pixels);
}

/// Double-sided triangles of a node each; every third is small.
SceneBuilder overlappingTriangles(unsigned seed, int count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> at(-2, 2), deep(-5, 2.5F), small(-0.2F, 0.2F);
    SceneBuilder builder;
    builder.material().doubleSided = true;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 first{at(random), at(random), deep(random)};
        std::vector<glm::vec3> corners{first};
        for (int c = 0; c < 2; ++c)
            corners.push_back(i % 3
                                  ? glm::vec3{at(random), at(random), deep(random)}
                                  : first + glm::vec3{small(random), small(random), small(random)});
        builder.addMesh(corners, {0, 1, 2});
    }
    return builder;
}

/// The same around an eye at (0, 0, 4).
SceneBuilder surroundingTriangles(unsigned seed, int count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> at(-3, 3);
    SceneBuilder builder;
    builder.material().doubleSided = true;
    for (int i = 0; i < count; ++i) {
        std::vector<glm::vec3> corners;
        for (int c = 0; c < 3; ++c) corners.push_back({at(random), at(random), at(random) + 4.0F});
        builder.addMesh(corners, {0, 1, 2});
    }
    return builder;
}

/// The same with an alpha of factor x texture, half of them with vertex colours as well.
SceneBuilder texturedTriangles(unsigned seed, int count, scene::AlphaMode mode) {
    auto builder = overlappingTriangles(seed, count);
    auto& scene = builder.scene();
    std::mt19937 random(seed);
    scene::Image image{7, 5, {}};
    for (int i = 0; i < 7 * 5 * 4; ++i) image.texels.push_back(static_cast<std::uint8_t>(random()));
    scene.images.push_back(image);
    auto& material = builder.material();
    material.alphaMode = mode;
    material.alphaCutoff = 0.35F;
    material.baseColor.w = 0.9F;
    material.baseColorTexture.image = 0;
    material.baseColorTexture.uvSet = 1;
    material.baseColorTexture.wrapV = scene::Wrap::mirror;
    std::uniform_real_distribution<float> uv(-1, 2), unit(0.6F, 1);
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        auto& p = scene.meshes[m].primitives[0];
        for (std::size_t i = 0; i < p.positions.size(); ++i) {
            p.uvs[0].emplace_back(0, 0);  // the set that must not be read
            p.uvs[1].push_back({uv(random), uv(random)});
            // Multiples of 1/255 survive being packed into bytes
            const auto byte = std::round(unit(random) * 255);
            if (m % 2) p.colors.emplace_back(1, 1, 1, byte / 255);
        }
    }
    return builder;
}

/// Triangles at `layers` depths for pixelCamera().
SceneBuilder exactTriangles(unsigned seed, int count, int layers, glm::dvec2 extent) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> x(0, extent.x), y(0, extent.y);
    SceneBuilder builder;
    builder.material().doubleSided = true;
    for (int i = 0; i < count; ++i) {
        const auto z = static_cast<float>(random() % static_cast<unsigned>(layers));
        std::vector<glm::vec3> corners;
        for (int c = 0; c < 3; ++c)
            corners.emplace_back(
                glm::dvec3{std::round(x(random) * 64) / 64, -std::round(y(random) * 64) / 64, z});
        builder.addMesh(corners, {0, 1, 2});
    }
    return builder;
}

}  // namespace

void expectOverlappingTrianglesSorted(RasterPath path) {
    const auto camera = perspectiveCamera({0.2, 0.1, 4}, {0, 0, 0}, 50);
    for (const auto& [width, height] : kSizes)
        for (unsigned seed = 0; seed < 3; ++seed) {
            const auto scene = overlappingTriangles(seed, 150).scene();
            const RasterReference twin(scene, camera, width, height);
            expectLikeTwin(rasterise(path, scene, camera, width, height), twin, 0.5);
        }
}

void expectTrianglesCutByTheNearPlane(RasterPath path) {
    auto camera = perspectiveCamera({0, 0, 4}, {0.3, -0.2, 0}, 75);
    camera.nearMetres = 0.2;
    for (const auto& [width, height] : kSizes)
        for (unsigned seed = 0; seed < 3; ++seed) {
            const auto scene = surroundingTriangles(seed, 40).scene();
            const RasterReference twin(scene, camera, width, height);
            expectLikeTwin(rasterise(path, scene, camera, width, height), twin, 0.5);
        }
}

void expectAlphaDecidesFragments(RasterPath path) {
    const auto camera = perspectiveCamera({0.2, 0.1, 4}, {0, 0, 0}, 50);
    for (const auto& [width, height] : kSizes)
        for (const bool nearest : {false, true}) {
            auto scene = texturedTriangles(7, 120, scene::AlphaMode::mask).scene();
            scene.materials[0].baseColorTexture.nearest = nearest;
            const RasterReference twin(scene, camera, width, height);
            expectLikeTwin(rasterise(path, scene, camera, width, height), twin, 0.2);
        }
}

void expectThresholdsAreKeptExactly(RasterPath path) {
    const auto camera = pixelCamera(33, 17);
    for (const auto mode : {scene::AlphaMode::mask, scene::AlphaMode::blend})
        for (const float alpha : {0.49F, 0.5F, 0.51F, 0.998F, 1.0F}) {
            SceneBuilder builder;
            builder.addQuad({0, -17, 0}, {33, 0, 0}, {0, 17, 0});
            builder.material().alphaMode = mode;
            builder.material().baseColor.w = alpha;  // MASK keeps its cutoff, BLEND nothing below 1
            const bool kept = mode == scene::AlphaMode::mask ? alpha >= 0.5F : alpha == 1;
            const auto image = rasterise(path, builder.scene(), camera, 33, 17);
            for (const int triangle : image.triangles) ASSERT_EQ(triangle >= 0, kept) << alpha;
        }
}

void expectTiesGoToTheLowestIndex(RasterPath path) {
    for (const auto& [width, height] : kSizes) {
        const auto camera = pixelCamera(width, height);
        const auto scene = exactTriangles(3, 90, 3, {width, height}).scene();
        const RasterReference twin(scene, camera, width, height);
        const auto image = rasterise(path, scene, camera, width, height);
        int wrong = 0, ties = 0;
        for (int row = 0; row < height; ++row)
            for (int column = 0; column < width; ++column) {
                int best = -1;
                double nearest = 0;
                // In the order of their indices: a later one must be nearer to win
                for (const auto& f : twin.fragments(column, row)) {
                    ties += best >= 0 && std::abs(f.depth - nearest) < 1e-9;
                    if (f.depth > nearest + 1e-9) best = f.triangle, nearest = f.depth;
                }
                wrong += image.triangles[static_cast<std::size_t>(row * width + column)] != best;
            }
        EXPECT_EQ(wrong, 0) << width << " x " << height;
        EXPECT_GT(ties, width * height / 2);
    }
}

void expectWordsOfTheTwin() {
    for (const auto& [width, height] : kSizes) {
        const auto camera = pixelCamera(width, height);
        const auto scene = exactTriangles(5, 90, 3, {width, height}).scene();
        const RasterReference twin(scene, camera, width, height);
        geometry::Geometry geometry(program("frame"), scene, glm::dvec3(0));
        const auto& mesh = geometry.run(scene::poseAt(scene, {}, 0));
        const auto [depths, ids] = run64(viewOf(camera, width, height), mesh);
        for (int i = 0; i < width * height; ++i) {
            const auto word = nearestWord(twin.fragments(i % width, i / width));
            const auto at = static_cast<std::size_t>(i);
            ASSERT_EQ(ids[at], static_cast<std::uint32_t>(word)) << i;
            // The last bit of a depth is the projection's, not the word's
            ASSERT_NEAR(std::bit_cast<float>(depths[at]),
                        std::bit_cast<float>(static_cast<std::uint32_t>(word >> 32)), 1e-6)
                << i;
        }
    }
}

void expectBackFacesAreDropped(RasterPath path) {
    const auto camera = perspectiveCamera({0.2, 0.1, 4}, {0, 0, 0}, 50);
    auto scene = overlappingTriangles(11, 150).scene();
    scene.materials[0].doubleSided = false;
    for (std::size_t n = 0; n < scene.nodes.size(); n += 2) scene.nodes[n].matrix[0][0] = -1;
    const RasterReference twin(scene, camera, 61, 37);
    expectLikeTwin(rasterise(path, scene, camera, 61, 37), twin, 0.3);
}

}  // namespace penumbra::tests
