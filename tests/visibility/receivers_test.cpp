// SPDX-License-Identifier: MIT
// Classification of pixels and what is kept of them, against the twin on random G-buffers.
#include <bit>
#include <cmath>
#include <random>

#include "kernels/shared/gbuffer.h"
#include "kernels/shared/mesh.h"
#include "runtime/kernel.h"
#include "tests/reference/map_lookup_ref.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using runtime::Buffer;
using U32 = std::uint32_t;

constexpr int kWidth = 37, kHeight = 23;
constexpr float kOffset = 1e-3F, kLeast = 2.5F;  // larger than in use, so that they show

shared::float4 row(const glm::dvec3& axis, double offset) {
    return {static_cast<float>(axis.x), static_cast<float>(axis.y), static_cast<float>(axis.z),
            static_cast<float>(offset)};
}

/// A random light and a random G-buffer about it.
struct Case {
    explicit Case(unsigned seed) : random(seed) {
        axes[2] = unit();
        axes[0] = glm::normalize(glm::cross(axes[2], unit()));
        axes[1] = glm::cross(axes[2], axes[0]);
        centre = glm::dvec3{between(-2, 2), between(-2, 2), between(-2, 2)};
        view = {0.6, 0.8, 0.7, 0.3, 93};
        image.width = kWidth;
        image.height = kHeight;
        image.planeStride = shared::gbufferStride(kWidth * kHeight);
        image.originOffset = kOffset;
        image.worldMagnitude = kLeast;
        image.countOutside = 1;
        stride = static_cast<std::size_t>(image.planeStride);
        planes.assign(GB_PLANES * stride, 0.0F);
        for (std::size_t i = 0; i < kWidth * kHeight; ++i) addPixel(i);
        for (int i = 0; i < 3; ++i)
            params.lightFromWorld.row[i] = row(axes[i], -glm::dot(axes[i], centre));
        params.near = static_cast<float>(view.near);
        params.focal = static_cast<float>(view.focal());
        params.centre = 0.5F * static_cast<float>(view.resolution);
        params.halfWidth = static_cast<float>(view.halfWidth);
        params.halfHeight = static_cast<float>(view.halfHeight);
        params.resolution = view.resolution;
    }
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    }
    glm::dvec3 unit() {
        return glm::normalize(glm::dvec3{between(-1, 1), between(-1, 1), between(-1, 1)});
    }
    /// Most pixels lie before the light and face it; some are background, some receive nothing.
    void addPixel(std::size_t i) {
        const double z = between(-1, 7);
        glm::dvec3 normal = unit();
        if (i % 3) normal = glm::normalize(normal - 1.5 * axes[2]);
        const glm::vec3 at{centre + axes[0] * between(-3, 3) + axes[1] * between(-3, 3) +
                           axes[2] * z};
        for (std::size_t k = 0; k < 3; ++k) {
            planes[(GB_POSITION + k) * stride + i] = at[static_cast<int>(k)];
            planes[(GB_GEOMETRIC + k) * stride + i] =
                static_cast<float>(normal[static_cast<int>(k)]);
        }
        planes[GB_OBJECT * stride + i] = std::bit_cast<float>(i % 11 ? 5U : 0U);
        planes[GB_FLAGS * stride + i] =
            std::bit_cast<float>(DRAW_ANY | (i % 7 ? DRAW_RECEIVES : DRAW_CASTS));
    }
    ReceiverReference twin(std::size_t i) const {
        glm::dvec3 position, normal;
        for (std::size_t k = 0; k < 3; ++k) {
            position[static_cast<int>(k)] = planes[(GB_POSITION + k) * stride + i];
            normal[static_cast<int>(k)] = planes[(GB_GEOMETRIC + k) * stride + i];
        }
        // Off the surface by a share of the largest coordinate
        double magnitude = kLeast;
        for (int k = 0; k < 3; ++k) magnitude = std::max(magnitude, std::abs(position[k]));
        const glm::dvec3 start =
            position + normal * magnitude * static_cast<double>(kOffset) - centre;
        PlaneReceiver r;
        for (int k = 0; k < 3; ++k) {
            r.origin[k] = glm::dot(axes[k], start);
            r.normal[k] = glm::dot(axes[k], normal);
        }
        return receiverReference(r, view, i % 11 != 0, i % 7 != 0);
    }
    std::mt19937 random;
    glm::dvec3 axes[3], centre;
    ViewGeometry view;
    shared::ReceiverParams image{};
    shared::MultiViewParams params{};
    std::size_t stride = 0;
    std::vector<float> planes;
};

struct Outcome {
    std::vector<float> receivers;
    std::vector<U32> state, hidden;
    U32 outside = 0;
    std::size_t slots = 0;
};

Outcome classify(Case& c, int step, U32 outsideState) {
    c.image.pixelStep = step;
    c.image.receiverWidth = (kWidth + step - 1) / step;
    c.image.receiverStride =
        shared::gbufferStride(c.image.receiverWidth * ((kHeight + step - 1) / step));
    c.image.outsideState = outsideState;
    Outcome out;
    out.slots = static_cast<std::size_t>(c.image.receiverStride);
    Buffer<float> planes(device(), "planes", c.planes),
        receivers(device(), "receivers", RECEIVER_PLANES * out.slots);
    Buffer<U32> state(device(), "state", c.stride), hidden(device(), "hidden", out.slots);
    Buffer<shared::MultiViewCounters> counters(device(), "counters", 1);
    receivers.fill(-1.0F);
    hidden.fill(77);
    state.fill(99);
    counters.fill({});
    runtime::Kernel<shared::ReceiverParams, shared::MultiViewParams, Buffer<float>, Buffer<float>,
                    Buffer<U32>, Buffer<U32>, Buffer<shared::MultiViewCounters>>
        kernel(program("multi_view"), "receivers");
    kernel.launch({c.stride}, {64}, c.image, c.params, planes, receivers, state, hidden, counters);
    out.receivers = receivers.download();
    out.state = state.download();
    out.hidden = hidden.download();
    out.outside = counters.download()[0].outsideFov;
    return out;
}

void expectReceiver(const Outcome& out, std::size_t slot, const ReceiverReference& twin,
                    std::size_t pixel) {
    const auto value = [&](std::size_t plane) { return out.receivers[plane * out.slots + slot]; };
    // Texels and metres of some tens in float; close to the light's plane z loses digits as w grows
    const double digits = 2e-5 * std::max(1.0, 0.1 * twin.w);
    EXPECT_NEAR(value(RECEIVER_A), twin.a, digits * (50 + std::abs(twin.a))) << pixel;
    EXPECT_NEAR(value(RECEIVER_B), twin.b, digits * (50 + std::abs(twin.b))) << pixel;
    EXPECT_NEAR(value(RECEIVER_W), twin.w, 4e-6 * (1 + twin.w * twin.w)) << pixel;
    EXPECT_NEAR(value(RECEIVER_GRADIENT_X), twin.slopeX, 1e-7) << pixel;
    EXPECT_NEAR(value(RECEIVER_GRADIENT_Y), twin.slopeY, 1e-7) << pixel;
    EXPECT_NEAR(value(RECEIVER_FACING), twin.facing, 1e-5) << pixel;
}

class ReceiversTest : public testing::TestWithParam<std::tuple<int, U32>> {};

TEST_P(ReceiversTest, StatesAndPlanesEqualTheTwin) {
    const auto [step, outsideState] = GetParam();
    for (unsigned seed = 1; seed <= 4; ++seed) {
        Case c(seed);
        const auto out = classify(c, step, outsideState);
        std::size_t counts[4] = {0, 0, 0, 0}, outside = 0, doubtful = 0;
        for (std::size_t i = 0; i < kWidth * kHeight; ++i) {
            const auto twin = c.twin(i);
            const bool traced =
                twin.state == STATE_TESTED && twin.outside && outsideState != STATE_TESTED;
            outside += twin.state == STATE_TESTED && twin.outside;
            if (twin.doubt < 1e-4) {
                ++doubtful;
                continue;
            }
            const U32 expected = traced ? outsideState : twin.state;
            ASSERT_EQ(out.state[i], expected) << "seed " << seed << " pixel " << i;
            ++counts[expected];
            const auto x = i % kWidth, y = i / kWidth;
            const auto s = static_cast<std::size_t>(step);
            if (x % s || y % s) continue;
            const auto slot = y / s * static_cast<std::size_t>(c.image.receiverWidth) + x / s;
            EXPECT_EQ(out.hidden[slot], 0U);
            if (expected == STATE_TESTED)
                expectReceiver(out, slot, twin, i);
            else
                EXPECT_EQ(out.receivers[RECEIVER_W * out.slots + slot], 0) << i;
        }
        EXPECT_LE(doubtful, 5U);
        EXPECT_NEAR(out.outside, static_cast<double>(outside), static_cast<double>(doubtful));
        EXPECT_GT(counts[STATE_MASKED], 50U);
        EXPECT_GT(counts[STATE_TESTED], 50U);
        EXPECT_GT(counts[STATE_LIT], 10U);
        EXPECT_GT(outside, 50U);
        for (std::size_t i = kWidth * kHeight; i < c.stride; ++i)
            ASSERT_EQ(out.state[i], STATE_MASKED);
    }
}

INSTANTIATE_TEST_SUITE_P(Steps, ReceiversTest,
                         testing::Combine(testing::Values(1, 2),
                                          testing::Values(STATE_OUTSIDE, STATE_TESTED)));

TEST(ReceiversCountTest, NothingIsCountedOutsideWhereTheViewsHoldAllCasters) {
    Case c(1);
    c.image.countOutside = 0;
    EXPECT_EQ(classify(c, 1, STATE_TESTED).outside, 0U);
}

}  // namespace
}  // namespace penumbra::tests
