// SPDX-License-Identifier: MIT
// Blended fragments over opaque pixels, against the twin in double.
#include "host/shading/composite.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "kernels/shared/gbuffer.h"
#include "tests/reference/composite_ref.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

struct Pixel {
    std::vector<Layer> layers;
    glm::dvec3 opaque{0};
    bool covered = true;
};

/// Composites pixels of one row on the device.
std::vector<Composited> composite(const std::vector<Pixel>& pixels) {
    const std::size_t width = pixels.size();
    std::vector<Layer> all;
    std::vector<std::uint32_t> ends;
    for (const auto& p : pixels) {
        all.insert(all.end(), p.layers.begin(), p.layers.end());
        ends.push_back(static_cast<std::uint32_t>(all.size()));
    }
    const std::size_t rows = all.size() / width + 1, capacity = rows * width;
    const auto stride =
        static_cast<std::size_t>(shared::gbufferStride(static_cast<int>(width + capacity)));
    std::vector<float> planes(GB_PLANES * stride, 0.0F), colour(3 * stride, 0.0F),
        coverage(COVERAGE_PLANES * capacity, 0.0F);
    for (std::size_t i = 0; i < width; ++i) {
        planes[GB_OBJECT * stride + i] = std::bit_cast<float>(pixels[i].covered ? 1U : 0U);
        for (std::size_t c = 0; c < 3; ++c)
            colour[c * stride + i] = static_cast<float>(pixels[i].opaque[static_cast<int>(c)]);
    }
    for (std::size_t f = 0; f < all.size(); ++f) {
        coverage[COVERAGE_ALPHA * capacity + f] = static_cast<float>(all[f].alpha);
        for (std::size_t c = 0; c < 3; ++c) {
            const auto channel = static_cast<int>(c);
            coverage[(COVERAGE_THROUGH + c) * capacity + f] =
                static_cast<float>(all[f].through[channel]);
            colour[c * stride + width + f] = static_cast<float>(all[f].colour[channel]);
        }
    }
    gbuffer::FragmentLists lists;
    lists.pixels = static_cast<int>(width);
    lists.capacity = static_cast<std::uint32_t>(capacity);
    lists.ends = runtime::Buffer<std::uint32_t>(device(), "ends", ends);
    lists.coverage = runtime::Buffer<float>(device(), "coverage", coverage);
    gbuffer::GBuffer gbuffer;
    gbuffer.width = static_cast<int>(width);
    gbuffer.height = 1;
    gbuffer.fragmentRows = static_cast<int>(rows);
    gbuffer.planeStride = static_cast<int>(stride);
    gbuffer.planes = runtime::Buffer<float>(device(), "planes", planes);
    gbuffer.blended = &lists;
    const runtime::Buffer<float> image(device(), "colour", colour);
    shading::Composite pass(program("frame"), static_cast<int>(width), 1);
    pass.run(gbuffer, image);
    const auto result = image.download(), alpha = pass.alpha().download();
    const auto front = pass.front().download();
    std::vector<Composited> out;
    for (std::size_t i = 0; i < width; ++i) {
        const std::size_t first = width + (i ? ends[i - 1] : 0);
        const int layer = front[i] == i ? -1 : static_cast<int>(front[i] - first);
        out.push_back({{result[i], result[stride + i], result[2 * stride + i]}, alpha[i], layer});
    }
    return out;
}

TEST(Composite, RandomListsAreWhatTheTwinMakesOfThem) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0, 1), bright(0, 5);
    std::vector<Pixel> pixels(301);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        auto& p = pixels[i];
        p.covered = i % 3 != 0;
        if (p.covered) p.opaque = {bright(random), bright(random), bright(random)};
        for (std::size_t k = 0; k < i % 13; ++k) {
            Layer layer;
            layer.alpha = unit(random);
            layer.colour = {bright(random), bright(random), bright(random)};
            for (int c = 0; c < 3; ++c)
                layer.through[c] = k % 2 ? 1 - layer.alpha : 1 - layer.alpha * unit(random);
            p.layers.push_back(layer);
        }
    }
    const auto mine = composite(pixels);
    int fronts = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const auto twin = compositeReference(pixels[i].layers, pixels[i].opaque, pixels[i].covered);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(mine[i].colour[c], twin.colour[c], 1e-5) << i;
        EXPECT_NEAR(mine[i].alpha, twin.alpha, 1e-6) << i;
        EXPECT_EQ(mine[i].front, twin.front) << i;
        fronts += twin.front > 0;
    }
    EXPECT_GT(fronts, 50);
}

TEST(Composite, AStackOfLayersLetsTheProductThrough) {
    // n layers of alpha a before white: (1 - a)^n shines through
    std::vector<Pixel> pixels;
    for (const int n : {0, 1, 2, 5, 50, 1000}) {
        Pixel p;
        p.opaque = glm::dvec3(1);
        p.layers.assign(static_cast<std::size_t>(n), {glm::dvec3(0), 0.004, glm::dvec3(0.996)});
        pixels.push_back(p);
    }
    const auto mine = composite(pixels);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double expected = std::pow(0.996, static_cast<double>(pixels[i].layers.size()));
        EXPECT_NEAR(mine[i].colour.x, expected, 1e-5);
        EXPECT_NEAR(mine[i].alpha, 1, 1e-6);
    }
}

TEST(Composite, TheOrderOfLayersCounts) {
    const Layer red{{1, 0, 0}, 0.5, glm::dvec3(0.5)}, green{{0, 1, 0}, 0.5, glm::dvec3(0.5)};
    const auto mine = composite({{{red, green}, {0, 0, 1}, true}, {{green, red}, {0, 0, 1}, true}});
    EXPECT_EQ(mine[0].colour, glm::dvec3(0.5, 0.25, 0.25));
    EXPECT_EQ(mine[1].colour, glm::dvec3(0.25, 0.5, 0.25));
}

TEST(Composite, AFilterTintsWhatIsBehindAndAddsItsOwnLight) {
    const Layer glass{{0.1, 0.1, 0.1}, 1, {0.9, 0.3, 0}};
    const auto mine = composite({{{glass}, {1, 1, 1}, true}});
    EXPECT_NEAR(mine[0].colour.x, 1.0, 1e-6);
    EXPECT_NEAR(mine[0].colour.y, 0.4, 1e-6);
    EXPECT_NEAR(mine[0].colour.z, 0.1, 1e-6);
}

}  // namespace
}  // namespace penumbra::tests
