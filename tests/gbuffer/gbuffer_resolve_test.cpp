// SPDX-License-Identifier: MIT
// Surface attributes of pixels against their double-precision twin.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "host/gbuffer/gbuffer.h"
#include "kernels/shared/gbuffer.h"
#include "tests/reference/gbuffer_resolve_ref.h"
#include "tests/reference/gbuffer_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

constexpr std::pair<int, int> kSizes[] = {{7, 5}, {33, 17}, {97, 61}};

scene::CameraFrame frontCamera() {
    return perspectiveCamera({0.3, 0.2, 4}, {0, 0, 0}, 50);
}

/// The G-buffer of `scene` one frame after `last`.
GBufferRun runAfter(const scene::Scene& last, const scene::Scene& scene,
                    const scene::CameraFrame& camera, int width, int height) {
    geometry::Geometry geometry(program("frame"), scene, glm::dvec3(0));
    geometry.run(scene::poseAt(last, {}, 0));
    const auto& mesh = geometry.run(scene::poseAt(scene, {}, 0));
    gbuffer::GBufferPass pass(program("frame"), width, height);
    do pass.run(mesh, camera, glm::dvec3(0));
    while (pass.grew());
    GBufferRun run;
    run.width = width;
    run.height = height;
    run.stride = static_cast<std::size_t>(pass.result().planeStride);
    run.planes = pass.result().planes.download();
    return run;
}

double distance(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 d = glm::abs(a - b);
    return std::max({d.x, d.y, d.z});
}

/// Largest difference of each kind at a pixel.
struct Error {
    double place = 0;  ///< of positions and depth, as a share of the depth
    double normal = 0;
    double colour = 0;  ///< of albedo, emission, metallic and roughness
    bool within() const {
        // Float positions keep 1e-7 of their magnitude, and barycentrics of a triangle that is
        // many screens wide lose two or three digits of it. Colours: noise textures change by up to
        // 1 a texel, and uvs are off by up to 1e-3 texels. Wrong wraps, levels, spaces or signs
        // cost 0.05 to 1 in most pixels.
        return place < 2e-5 && normal < 4e-3 && colour < 4e-3;
    }
};

Error errorOf(const GBufferRun& run, int x, int y, const SurfaceReference& s) {
    Error e;
    e.place = std::max({distance(run.vector(GB_POSITION, x, y), s.position),
                        distance(run.vector(GB_PREVIOUS, x, y), s.previous),
                        std::abs(run.value(GB_DEPTH, x, y) - s.depth)}) /
              s.depth;
    e.normal = std::max(distance(run.vector(GB_GEOMETRIC, x, y), s.geometric),
                        distance(run.vector(GB_NORMAL, x, y), s.normal));
    e.colour = std::max({distance(run.vector(GB_ALBEDO, x, y), s.albedo),
                         distance(run.vector(GB_EMISSIVE, x, y), s.emissive),
                         std::abs(run.value(GB_METALLIC, x, y) - s.metallic),
                         std::abs(run.value(GB_ROUGHNESS, x, y) - s.roughness)});
    return e;
}

/// Compares all pixels that show something; `share` of the image must, so that there was something
/// to compare. `last`: the frame before, or null where nothing moved.
void expectLikeTwin(const scene::Scene& scene, const scene::Scene* last,
                    const scene::CameraFrame& camera, int width, int height, double share) {
    const auto run = last ? runAfter(*last, scene, camera, width, height)
                          : runGBuffer(scene, camera, width, height);
    const ResolveReference twin(scene, last ? *last : scene, camera, width, height);
    int shown = 0, compared = 0, wrong = 0;
    Error worst;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            if (run.object(x, y) == 0) continue;
            ++shown;
            double margin = 0;
            const int triangle = twin.triangleAt(run.object(x, y), x, y, margin);
            // Within 1/256 pixel of an edge snapping decides, and outside the kernel clamps
            if (triangle < 0 || margin < 2e-3) continue;
            // Where the footprint is just a power of two, both levels are right
            const auto fine = twin.surface(triangle, x, y, -2e-3);
            const auto coarse = twin.surface(triangle, x, y, 2e-3);
            if (fine.atTexelBorder || coarse.atTexelBorder) continue;
            ++compared;
            const Error a = errorOf(run, x, y, fine), b = errorOf(run, x, y, coarse);
            const Error e = a.within() ? a : b;
            wrong += !e.within();
            worst.place = std::max(worst.place, e.place);
            worst.normal = std::max(worst.normal, e.normal);
            worst.colour = std::max(worst.colour, e.colour);
        }
    // Triangles that are seen edge-on lose more digits than that: a pixel in a thousand
    EXPECT_LE(wrong, compared / 1000 + 1)
        << width << " x " << height << ": place " << worst.place << " normal " << worst.normal
        << " colour " << worst.colour;
    EXPECT_GE(shown, share * width * height);
    EXPECT_GE(compared, 0.7 * shown);
}

void expectLikeTwin(const scene::Scene& scene, double share) {
    for (const auto& [width, height] : kSizes)
        expectLikeTwin(scene, nullptr, frontCamera(), width, height, share);
}

/// A random image whose texels differ from their neighbours.
scene::Image noise(unsigned seed, int width, int height) {
    std::mt19937 random(seed);
    scene::Image image{width, height, {}};
    for (int i = 0; i < width * height * 4; ++i)
        image.texels.push_back(static_cast<std::uint8_t>(random()));
    return image;
}

/// A map of slopes of up to 35 degrees.
scene::Image slopes(unsigned seed, int width, int height) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    scene::Image image{width, height, {}};
    for (int i = 0; i < width * height; ++i) {
        const glm::dvec3 n = glm::normalize(glm::dvec3{0.5 * unit(random), 0.5 * unit(random), 1});
        for (int axis = 0; axis < 3; ++axis)
            image.texels.push_back(static_cast<std::uint8_t>(std::lround(127.5 * (n[axis] + 1))));
        image.texels.push_back(255);
    }
    return image;
}

/// Double-sided triangles, a node each: smooth normals, colours, two sets of uvs, scaled, turned
/// and (every third) mirroring nodes.
SceneBuilder variedTriangles(unsigned seed, int count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> at(-1.5F, 1.5F), deep(-3, 2), small(-0.4F, 0.4F);
    std::uniform_real_distribution<float> uv(-1.5F, 2.5F);
    SceneBuilder builder;
    builder.material().doubleSided = true;
    for (int i = 0; i < count; ++i) {
        std::vector<glm::vec3> corners;
        for (int c = 0; c < 3; ++c) corners.push_back({at(random), at(random), deep(random)});
        glm::dmat4 matrix(1);
        matrix[0] = {i % 3 ? 1.25 : -0.75, 0.25, 0, 0};
        matrix[1] = {-0.5, 1.5, 0.25, 0};
        builder.addMesh(corners, {0, 1, 2}, matrix);
        auto& p = builder.scene().meshes.back().primitives[0];
        for (auto& n : p.normals)
            n = glm::normalize(n + glm::vec3{small(random), small(random), small(random)});
        for (int c = 0; c < 3; ++c) {
            for (auto& set : p.uvs) set.push_back({uv(random), uv(random)});
            glm::vec4 colour;
            for (int k = 0; k < 4; ++k) colour[k] = static_cast<float>(random() % 256) / 255;
            if (i % 2) p.colors.push_back(colour);
        }
    }
    return builder;
}

TEST(GBufferResolve, PositionsNormalsAndColoursAreThoseOfThePixelsCentre) {
    auto builder = variedTriangles(1, 70);
    builder.material().baseColor = {0.9F, 0.6F, 0.3F, 1};
    builder.material().emissive = {0.1F, 2, 0.3F};
    builder.material().metallic = 0.7F;
    builder.material().roughness = 0.4F;
    expectLikeTwin(builder.scene(), 0.4);
}

TEST(GBufferResolve, TexturesOfEveryWrapAndFilterAreReadAtTheirLevel) {
    const scene::Wrap wraps[] = {scene::Wrap::repeat, scene::Wrap::clamp, scene::Wrap::mirror};
    for (const bool nearest : {false, true})
        for (int combination = 0; combination < 9; ++combination) {
            auto builder = variedTriangles(static_cast<unsigned>(combination), 70);
            auto& scene = builder.scene();
            scene.images = {noise(1, 13, 6), noise(2, 128, 64), noise(3, 32, 33)};
            auto& m = builder.material();
            m.baseColor = {0.9F, 0.8F, 1, 1};
            m.emissive = glm::vec3(1, 0.5F, 2);
            m.metallic = 0.9F;
            m.roughness = 0.8F;
            int image = 0;
            for (auto* use :
                 {&m.baseColorTexture, &m.emissiveTexture, &m.metallicRoughnessTexture}) {
                use->image = image++;
                use->wrapU = wraps[(combination + image) % 3];
                use->wrapV = wraps[(combination / 3 + image) % 3];
                use->nearest = nearest;
                use->uvSet = (combination + image) % 2;
            }
            expectLikeTwin(scene, 0.4);
        }
}

TEST(GBufferResolve, TextureTransformsTurnScaleAndMoveUvs) {
    auto builder = variedTriangles(4, 70);
    auto& scene = builder.scene();
    scene.images = {noise(1, 16, 16), noise(2, 64, 32)};
    auto& m = builder.material();
    m.baseColorTexture.image = 0;
    m.emissive = glm::vec3(1);
    m.emissiveTexture.image = 1;
    // KHR_texture_transform: offset, then rotation (anticlockwise, v down), then scale
    const float c = std::cos(0.7F), s = std::sin(0.7F);
    m.baseColorTexture.uvFromUv = glm::mat3x2(3 * c, -3 * s, 0.5F * s, 0.5F * c, 0.25F, -0.75F);
    m.emissiveTexture.uvFromUv = glm::mat3x2(-1, 0, 0, 4, 0.125F, 0);
    expectLikeTwin(scene, 0.4);
}

TEST(GBufferResolve, FarTexelsComeFromCoarseLevels) {
    SceneBuilder builder;
    builder.addQuad({-6, -0.7F, 3}, {12, 0, 0}, {0, 0, -30});
    auto& scene = builder.scene();
    scene.images = {noise(5, 256, 256)};
    builder.material().baseColorTexture.image = 0;
    auto& p = scene.meshes[0].primitives[0];
    for (const auto& v : p.positions) p.uvs[0].emplace_back(v.x / 2, v.z / 2);
    expectLikeTwin(scene, 0.2);
}

TEST(GBufferResolve, SmallTrianglesReadTheLevelOfTheirFootprint) {
    // Triangles of about a pixel: the neighbours that tell the footprint lie outside of them
    SceneBuilder builder;
    constexpr int kCells = 24;
    std::vector<glm::vec3> corners;
    std::vector<std::uint32_t> indices;
    for (int y = 0; y <= kCells; ++y)
        for (int x = 0; x <= kCells; ++x)
            corners.emplace_back(-1 + 2.0F * static_cast<float>(x) / kCells,
                                 -1 + 2.0F * static_cast<float>(y) / kCells, 0);
    for (std::uint32_t y = 0; y < kCells; ++y)
        for (std::uint32_t x = 0; x < kCells; ++x) {
            const std::uint32_t a = y * (kCells + 1) + x, b = a + kCells + 1;
            for (const auto i : {a, a + 1, b + 1, a, b + 1, b}) indices.push_back(i);
        }
    builder.addMesh(corners, indices);
    auto& scene = builder.scene();
    scene.images = {noise(6, 128, 128)};
    builder.material().baseColorTexture.image = 0;
    auto& p = scene.meshes[0].primitives[0];
    for (const auto& v : p.positions) p.uvs[0].emplace_back(0.5F + v.x, 0.5F - v.y);
    expectLikeTwin(scene, nullptr, frontCamera(), 33, 17, 0.1);
    expectLikeTwin(scene, nullptr, frontCamera(), 61, 37, 0.1);
}

/// Normal maps on triangles whose uvs are mirrored or not, in mirroring nodes or not, seen from the
/// front and from the back. `tangents`: given by the mesh, of either handedness.
scene::Scene bumpedTriangles(bool tangents) {
    auto builder = variedTriangles(9, 70);
    auto& scene = builder.scene();
    scene.images = {slopes(7, 16, 16)};
    auto& m = builder.material();
    m.normalTexture.image = 0;
    m.normalTexture.uvFromUv = glm::mat3x2(0.5F, 0.1F, -0.1F, 0.5F, 0, 0);
    m.normalScale = 0.8F;
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    for (std::size_t i = 0; tangents && i < scene.meshes.size(); ++i) {
        auto& p = scene.meshes[i].primitives[0];
        const glm::vec3 along{normal(random), normal(random), normal(random)};
        for (const auto& n : p.normals)
            p.tangents.emplace_back(glm::normalize(glm::cross(n, along)), i % 2 ? 1 : -1);
    }
    return scene;
}

TEST(GBufferResolve, NormalMapsFollowTheTangentsThatAreGiven) {
    expectLikeTwin(bumpedTriangles(true), 0.4);
}

TEST(GBufferResolve, NormalMapsFollowTheUvsWhereNoTangentsAreGiven) {
    expectLikeTwin(bumpedTriangles(false), 0.4);
}

TEST(GBufferResolve, GreenOfANormalMapPointsUpInTheImage) {
    // A square with its image upright; all texels lean to the image's upper right
    SceneBuilder builder;
    builder.addQuad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    auto& scene = builder.scene();
    scene.images = {{1, 1, {191, 218, 218, 255}}};  // (0.5, 0.71, 0.71) / 1.1
    builder.material().normalTexture.image = 0;
    auto& p = scene.meshes[0].primitives[0];
    for (const auto& v : p.positions) p.uvs[0].emplace_back(0.5F + 0.5F * v.x, 0.5F - 0.5F * v.y);
    const auto derived = runGBuffer(scene, frontCamera(), 33, 17).vector(GB_NORMAL, 16, 8);
    EXPECT_NEAR(derived.x, 0.445, 0.01);
    EXPECT_NEAR(derived.y, 0.634, 0.01);
    for (std::size_t i = 0; i < p.positions.size(); ++i) p.tangents.emplace_back(1, 0, 0, 1);
    const auto given = runGBuffer(scene, frontCamera(), 33, 17).vector(GB_NORMAL, 16, 8);
    EXPECT_LT(glm::length(given - derived), 1e-5);
}

TEST(GBufferResolve, UnlitSurfacesEmitTheirColourAndNothingElse) {
    auto builder = variedTriangles(5, 70);
    auto& scene = builder.scene();
    scene.images = {noise(8, 16, 16)};
    auto& m = builder.material();
    m.unlit = true;
    m.baseColor = {0.5F, 1, 0.25F, 1};
    m.baseColorTexture.image = 0;
    m.emissive = glm::vec3(0.3F);
    m.metallic = 1;
    expectLikeTwin(scene, 0.4);
}

TEST(GBufferResolve, PreviousPositionsAreThoseOfTheSameSurfacePoint) {
    const auto last = variedTriangles(6, 70).scene();
    auto scene = last;
    std::mt19937 random(4);
    std::uniform_real_distribution<double> move(-0.3, 0.3);
    for (auto& node : scene.nodes)
        for (int axis = 0; axis < 3; ++axis) node.matrix[3][axis] += move(random);
    for (const auto& [width, height] : kSizes)
        expectLikeTwin(scene, &last, frontCamera(), width, height, 0.4);
}

TEST(GBufferResolve, OrthographicCamerasSeeTheSameSurfaces) {
    auto builder = variedTriangles(7, 70);
    auto& scene = builder.scene();
    scene.images = {noise(9, 32, 32)};
    builder.material().baseColorTexture.image = 0;
    scene::CameraFrame camera;
    camera.orthographic = true;
    camera.xmag = 1.8, camera.ymag = 1.1;
    camera.nearMetres = 0.5, camera.farMetres = 30;
    camera.worldFromCamera = scene::lookAt({3, 2, 6}, {0, 0, 0}, {0, 1, 0});
    expectLikeTwin(scene, nullptr, camera, 33, 17, 0.5);
    expectLikeTwin(scene, nullptr, camera, 61, 37, 0.5);
}

TEST(GBufferResolve, ObjectsFlagsAndBackgroundTellWhatAPixelShows) {
    auto builder = variedTriangles(8, 12);
    builder.scene().nodes[3].receiveShadow = false;
    const auto& scene = builder.scene();
    const auto run = runGBuffer(scene, frontCamera(), 33, 17);
    int background = 0;
    for (int y = 0; y < 17; ++y)
        for (int x = 0; x < 33; ++x) {
            const auto object = run.object(x, y);
            const auto flags = std::bit_cast<std::uint32_t>(run.value(GB_FLAGS, x, y));
            background += object == 0;
            if (object == 0) {
                EXPECT_TRUE(std::isinf(run.value(GB_DEPTH, x, y)));
                EXPECT_EQ(flags, 0U);
                continue;
            }
            ASSERT_LE(object, scene.nodes.size());
            EXPECT_EQ((flags & DRAW_RECEIVES) != 0, object != 4);
            EXPECT_EQ((flags & DRAW_MIRRORED) != 0, (object - 1) % 3 == 0);
        }
    EXPECT_GT(background, 10);
    EXPECT_LT(background, 33 * 17 - 100);
    // The padding of the planes is background too
    for (std::size_t i = 33 * 17; i < run.stride; ++i)
        ASSERT_TRUE(std::isinf(run.planes[GB_DEPTH * run.stride + i]));
}

}  // namespace
}  // namespace penumbra::tests
