// SPDX-License-Identifier: MIT
// From hidden weights to visibility: at every pixel, and from every other one by upsampling.
#include <cmath>
#include <random>

#include "kernels/shared/gbuffer.h"
#include "runtime/kernel.h"
#include "tests/reference/map_lookup_ref.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using runtime::Buffer;
using U32 = std::uint32_t;

TEST(MapAverageTest, IsTheShareOfTheTestsPassedAndOneWhereNoneWasMade) {
    std::mt19937 random(1);
    for (const int count : {1, 63, 1003}) {
        const auto [views, weight] = std::pair(7, 9);
        std::vector<U32> state, hidden;
        for (int i = 0; i < count; ++i) {
            state.push_back(static_cast<U32>(random()) % 4);
            hidden.push_back(static_cast<U32>(random()) % (views * weight + 1));
        }
        const auto n = static_cast<std::size_t>(count);
        Buffer<U32> states(device(), "states", state), weights(device(), "hidden", hidden);
        Buffer<float> visibility(device(), "visibility", n + 5);
        visibility.fill(-3.0F);
        runtime::Kernel<int, int, int, Buffer<U32>, Buffer<U32>, Buffer<float>> kernel(
            program("multi_view"), "map_average");
        kernel.launch({n}, {64}, count, views, weight, states, weights, visibility);
        const auto values = visibility.download();
        for (std::size_t i = 0; i < n; ++i)
            EXPECT_NEAR(values[i], state[i] == STATE_TESTED ? 1 - hidden[i] / 63.0 : 1, 1e-7);
        for (std::size_t i = n; i < n + 5; ++i) EXPECT_EQ(values[i], -3);
    }
}

/// An image of random facets with values at even pixels.
struct Image {
    Image(unsigned seed, int w, int h) : width(w), height(h) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> unit(-1, 1);
        std::vector<glm::dvec3> normals, origins;
        for (int k = 0; k < 3; ++k) {
            normals.push_back(
                glm::normalize(glm::dvec3{0.3 * unit(random), 0.3 * unit(random), 1}));
            origins.emplace_back(0, 0, 4 * unit(random));
        }
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                // Facets meet along slanted lines; a few pixels are not tested
                const auto k = static_cast<std::size_t>((x + 2 * y) / 9 % 3);
                UpsamplePixel p;
                p.normal = glm::dvec3(glm::vec3(normals[k]));
                const double z = origins[k].z - (p.normal.x * x + p.normal.y * y) / p.normal.z;
                p.position = glm::dvec3(glm::vec3(x, y, z + 0.02 * unit(random)));
                p.tested = random() % 8 != 0;
                hidden.push_back(static_cast<U32>(random()) % 321);
                p.value = 1 - hidden.back() / 320.0;
                pixels.push_back(p);
            }
    }
    UpsamplePixel& at(int x, int y) { return pixels[static_cast<std::size_t>(y * width + x)]; }
    int width, height;
    std::vector<UpsamplePixel> pixels;
    std::vector<U32> hidden;  ///< of 320, where column and row are even
};

std::vector<float> upsample(const Image& image) {
    shared::ReceiverParams params{};
    params.width = image.width;
    params.height = image.height;
    params.planeStride = shared::gbufferStride(image.width * image.height);
    params.pixelStep = 2;
    params.receiverWidth = (image.width + 1) / 2;
    const auto stride = static_cast<std::size_t>(params.planeStride);
    std::vector<float> planes(GB_PLANES * stride, 0.0F);
    std::vector<U32> state(stride, STATE_MASKED), hidden(stride, 0);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const auto& p = image.pixels[i];
        for (std::size_t k = 0; k < 3; ++k) {
            planes[(GB_POSITION + k) * stride + i] =
                static_cast<float>(p.position[static_cast<int>(k)]);
            planes[(GB_GEOMETRIC + k) * stride + i] =
                static_cast<float>(p.normal[static_cast<int>(k)]);
        }
        state[i] = p.tested ? STATE_TESTED : STATE_MASKED;
        const auto w = static_cast<std::size_t>(image.width), x = i % w, y = i / w;
        if (x % 2 == 0 && y % 2 == 0) hidden[y / 2 * ((w + 1) / 2) + x / 2] = image.hidden[i];
    }
    Buffer<float> planeBuffer(device(), "planes", planes),
        visibility(device(), "visibility", stride);
    Buffer<U32> states(device(), "states", state), weights(device(), "hidden", hidden);
    runtime::Kernel<shared::ReceiverParams, int, int, Buffer<float>, Buffer<U32>, Buffer<U32>,
                    Buffer<float>>
        kernel(program("multi_view"), "map_upsample");
    kernel.launch({stride}, {64}, params, 64, 5, planeBuffer, states, weights, visibility);
    return visibility.download();
}

TEST(MapUpsampleTest, EqualsTheTwinAcrossFacetsBordersAndUntestedPixels) {
    for (const auto& [width, height] :
         {std::pair(1, 1), {2, 2}, {3, 1}, {37, 23}, {64, 33}, {50, 50}})
        for (unsigned seed = 1; seed <= 3; ++seed) {
            const Image image(seed, width, height);
            const auto values = upsample(image);
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                    // Float positions of up to 64: weights are good for a few 1e-6
                    EXPECT_NEAR(values[static_cast<std::size_t>(y * width + x)],
                                upsampleReference(image.pixels, width, height, x, y), 5e-5)
                        << x << ',' << y << " of " << width << 'x' << height << " seed " << seed;
        }
}

TEST(MapUpsampleTest, ALinearRampOnOnePlaneIsKeptInsideOfTheImage) {
    Image image(1, 32, 24);
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x) {
            const auto hidden = static_cast<U32>(5 * x + 2 * y);
            image.at(x, y) = {{x, y, 0}, {0, 0, 1}, true, 1 - hidden / 320.0};
            image.hidden[static_cast<std::size_t>(y * 32 + x)] = hidden;
        }
    const auto values = upsample(image);
    for (int y = 0; y < 23; ++y)
        for (int x = 0; x < 31; ++x)
            EXPECT_NEAR(values[static_cast<std::size_t>(y * 32 + x)], image.at(x, y).value, 2e-6);
}

TEST(MapUpsampleTest, ValuesDoNotCrossAStepBetweenSurfaces) {
    Image image(1, 31, 20);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 31; ++x) {
            // A wall of white before a floor of black: at another height, or turned away
            const bool near = x >= 13, turned = y >= 10;
            const glm::dvec3 normal =
                near && turned ? glm::dvec3(0.8, 0, 0.6) : glm::dvec3(0, 0, 1);
            const double height = !near ? 0 : turned ? (13 - x) * 0.8 / 0.6 : 5;
            image.at(x, y) = {{x, y, height}, normal, true, near ? 1.0 : 0.0};
            image.hidden[static_cast<std::size_t>(y * 31 + x)] = near ? 0 : 320;
        }
    const auto values = upsample(image);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 31; ++x)
            EXPECT_EQ(values[static_cast<std::size_t>(y * 31 + x)], x >= 13 ? 1 : 0)
                << x << ',' << y;
}

}  // namespace
}  // namespace penumbra::tests
