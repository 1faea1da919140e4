// SPDX-License-Identifier: MIT
// Shadow tests, averages and upsampling against the twin, on random maps, planes and images.
#include <bit>
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

constexpr int kReceivers = 1003, kViews = 5, kFirstBatch = 3;

/// Receivers on a plane, and a map per view whose texels lie a few of the plane's steps about the
/// plane's own depth: bias and slope decide most tests.
struct Case {
    Case(unsigned seed, int resolution) : random(seed), view{0.7, 0.9, 0.4, 0.3, resolution} {
        const glm::dvec3 normal =
            glm::normalize(glm::dvec3{between(-1, 1), between(-1, 1), between(-1.2, -0.4)});
        const double distance = between(2, 4);
        for (int i = 0; i < kReceivers; ++i) {
            // Some views do not hold all of them: rays up to a tenth beyond the map's border
            const glm::dvec3 ray{1.1 * view.tanHalfFov * between(-1, 1),
                                 1.1 * view.tanHalfFov * between(-1, 1), 1};
            const double z = distance * normal.z / glm::dot(normal, ray);
            receivers.push_back({z > 0.3 && z < 30 ? ray * z : ray * distance, normal});
        }
        for (int v = 0; v < kViews; ++v) {
            samples.push_back({view.halfWidth * between(-1, 1), view.halfHeight * between(-1, 1)});
            maps.push_back(mapAbout(normal, distance, samples.back()));
        }
    }
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    }
    std::vector<double> mapAbout(const glm::dvec3& normal, double distance,
                                 const glm::dvec2& sample) {
        std::vector<double> map;
        const double middle = 0.5 * view.resolution,
                     at = distance * normal.z - glm::dot(normal, glm::dvec3(sample, 0));
        for (int row = 0; row < view.resolution; ++row)
            for (int column = 0; column < view.resolution; ++column) {
                const glm::dvec3 ray((column + 0.5 - middle) / view.focal(),
                                     (row + 0.5 - middle) / view.focal(), 1);
                const double depth = view.near * glm::dot(normal, ray) / at;
                const double step = view.near * (std::abs(normal.x) + std::abs(normal.y)) /
                                    (view.focal() * std::abs(at));
                const double chance = between(0, 1);
                map.push_back(chance < 0.1   ? 0
                              : chance < 0.2 ? between(0, 1)
                                             : std::clamp(depth + between(-1, 3) * step, 0.0, 1.0));
            }
        return map;
    }
    std::mt19937 random;
    ViewGeometry view;
    std::vector<PlaneReceiver> receivers;
    std::vector<glm::dvec2> samples;
    std::vector<std::vector<double>> maps;  ///< [view]
};

/// Receiver planes as kernels/shared/multi_view.h has them; every ninth is not to be tested.
std::vector<float> receiverPlanes(const Case& c, std::size_t stride) {
    std::vector<float> planes(RECEIVER_PLANES * stride, 0.0F);
    for (std::size_t i = 0; i < c.receivers.size(); ++i) {
        if (i % 9 == 4) continue;
        const auto& r = c.receivers[i];
        const double middle = 0.5 * c.view.resolution;
        const double values[] = {c.view.focal() * r.origin.x / r.origin.z + middle,
                                 c.view.focal() * r.origin.y / r.origin.z + middle,
                                 c.view.near / r.origin.z,
                                 c.view.near * r.normal.x / c.view.focal(),
                                 c.view.near * r.normal.y / c.view.focal(),
                                 -glm::dot(r.normal, r.origin)};
        for (std::size_t k = 0; k < RECEIVER_PLANES; ++k)
            planes[k * stride + i] = static_cast<float>(values[k]);
    }
    return planes;
}

template <typename Texel>
Texel texelOf(double depth) {
    if constexpr (sizeof(Texel) == 2)
        return static_cast<Texel>(std::lround(depth * 65535));
    else
        return std::bit_cast<Texel>(static_cast<float>(depth));
}

/// Runs the kernel in two batches of views; hidden weights start at 1000. Maps become what their
/// texels hold.
template <typename Texel>
std::vector<U32> lookUp(Case& c, const LookupSettings& settings) {
    const auto stride = static_cast<std::size_t>(shared::gbufferStride(kReceivers));
    const auto texels = static_cast<std::size_t>(c.view.resolution * c.view.resolution);
    shared::MultiViewParams params{};
    params.resolution = c.view.resolution;
    params.near = static_cast<float>(c.view.near);
    params.focal = static_cast<float>(c.view.focal());
    params.mapStride = static_cast<int>((texels + 16) / 16 * 16);
    shared::LookupParams lookup{};
    lookup.pcf = settings.pcf;
    lookup.slopeBias = static_cast<float>(settings.slopeBias);
    lookup.constantTexels = static_cast<float>(settings.constantTexels);
    lookup.constantMetres = static_cast<float>(settings.constantMetres);
    lookup.quantum = static_cast<float>(settings.quantum);
    std::vector<float> offsets;
    for (const auto& s : c.samples) {
        offsets.push_back(static_cast<float>(s.x * c.view.focal() / c.view.near));
        offsets.push_back(static_cast<float>(s.y * c.view.focal() / c.view.near));
    }
    Buffer<float> receivers(device(), "receivers", receiverPlanes(c, stride)),
        samples(device(), "samples", offsets);
    Buffer<U32> hidden(device(), "hidden", stride);
    hidden.fill(1000);
    runtime::Kernel<shared::MultiViewParams, shared::LookupParams, int, Buffer<float>,
                    Buffer<float>, Buffer<Texel>, Buffer<U32>>
        kernel(program("multi_view"), sizeof(Texel) == 2 ? "map_lookup16" : "map_lookup");
    for (int first = 0; first < kViews; first += kFirstBatch) {
        lookup.firstView = lookup.mapView = first;
        lookup.viewCount = std::min(kFirstBatch, kViews - first);
        // The slot behind each map holds what fell outside: the nearest depth there is
        std::vector<Texel> maps(static_cast<std::size_t>(params.mapStride * lookup.viewCount),
                                texelOf<Texel>(1));
        for (int v = 0; v < lookup.viewCount; ++v)
            for (std::size_t i = 0; i < texels; ++i) {
                auto& depth = c.maps[static_cast<std::size_t>(first + v)][i];
                const Texel texel = texelOf<Texel>(depth);
                if constexpr (sizeof(Texel) == 2)
                    depth = texel / 65535.0;
                else
                    depth = std::bit_cast<float>(texel);
                maps[static_cast<std::size_t>(v * params.mapStride) + i] = texel;
            }
        Buffer<Texel> buffer(device(), "maps", maps);
        kernel.launch({stride / static_cast<std::size_t>(device().info().lanes)}, {64}, params,
                      lookup, static_cast<int>(stride), receivers, samples, buffer, hidden);
    }
    return hidden.download();
}

template <typename Texel>
void expectTwin(unsigned seed, int resolution, const LookupSettings& settings) {
    Case c(seed, resolution);
    const auto hidden = lookUp<Texel>(c, settings);
    const auto all = static_cast<std::size_t>(settings.pcf == 4 ? 256 : settings.pcf) * kViews;
    std::size_t doubt = 0, sum = 0, tests = 0;
    for (std::size_t i = 0; i < hidden.size(); ++i) {
        HiddenWeight twin;
        if (i < kReceivers && i % 9 != 4) {
            for (std::size_t v = 0; v < kViews; ++v) {
                const auto one =
                    hiddenReference(c.receivers[i], c.view, c.samples[v], c.maps[v], settings);
                twin.low += one.low;
                twin.high += one.high;
            }
            tests += all;
        }
        const int is = static_cast<int>(hidden[i]) - 1000;
        EXPECT_TRUE(is >= twin.low && is <= twin.high)
            << is << " is not within " << twin.low << " and " << twin.high << ", receiver " << i;
        doubt += static_cast<std::size_t>(twin.high - twin.low);
        sum += static_cast<std::size_t>(twin.low);
    }
    // What float may decide is rare, and neither answer fills the image
    EXPECT_LT(doubt, tests / (settings.pcf == 4 ? 30 : 100));
    EXPECT_GT(sum, tests / 10);
    EXPECT_LT(sum, tests * 9 / 10);
}

class MapLookupTest : public testing::TestWithParam<int> {};

TEST_P(MapLookupTest, HiddenWeightsEqualTheTwinWithBothTexels) {
    for (unsigned seed = 1; seed <= 3; ++seed)
        for (const int resolution : {33, 64, 101}) {
            LookupSettings settings;
            settings.pcf = GetParam();
            settings.slopeBias = 1.1;
            settings.constantTexels = 0.25;
            expectTwin<U32>(seed, resolution, settings);
            settings.quantum = 1.0 / 65535;
            expectTwin<std::uint16_t>(seed, resolution, settings);
        }
}

TEST_P(MapLookupTest, EveryKindOfBiasMovesTheTestsAsTheTwinSays) {
    for (const auto& [slope, texels, metres] :
         {std::array{0.0, 0.0, 0.0}, {2.5, 0.0, 0.0}, {0.0, 1.5, 0.0}, {0.0, 0.0, 0.05}}) {
        LookupSettings settings;
        settings.pcf = GetParam();
        settings.slopeBias = slope;
        settings.constantTexels = texels;
        settings.constantMetres = metres;
        expectTwin<U32>(11, 57, settings);
    }
}

INSTANTIATE_TEST_SUITE_P(Filters, MapLookupTest, testing::Values(1, 5, 9, 4));

}  // namespace
}  // namespace penumbra::tests
