// SPDX-License-Identifier: MIT
#include "tests/reference/occupancy_ref.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/shared/multi_view.h"
#include "kernels/shared/occupancy.h"

namespace penumbra::tests {
namespace {

struct Box {
    double lowA = 1e30, highA = -1e30, lowB = 1e30, highB = -1e30;
    bool meets(const Box& other, double margin) const {
        return lowA <= other.highA + margin && highA >= other.lowA - margin &&
               lowB <= other.highB + margin && highB >= other.lowB - margin;
    }
};

double apply(const shared::float4& row, const std::array<double, 3>& p) {
    return row.x * p[0] + row.y * p[1] + row.z * p[2] + row.w;
}

/// Bounds of each caster in the central view, texels; `highest`: the largest near / z.
std::vector<Box> casterBounds(const geometry::Mesh& mesh, const shared::MultiViewParams& p,
                              double& highest) {
    const auto positions = mesh.positions.download();
    const auto indices = mesh.indices.download();
    const auto triangleDraw = mesh.triangleDraw.download();
    const auto draws = mesh.draws.download();
    std::vector<Box> boxes;
    for (std::size_t t = 0; t < mesh.triangleCount; ++t) {
        if (!(draws[triangleDraw[t]].flags & DRAW_CASTS)) continue;
        Box box;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t v = 3 * static_cast<std::size_t>(indices[3 * t + c]);
            const std::array<double, 3> at{positions[v], positions[v + 1], positions[v + 2]};
            const double z = apply(p.lightFromWorld.row[2], at);
            const double a = p.focal * apply(p.lightFromWorld.row[0], at) / z + p.centre;
            const double b = p.focal * apply(p.lightFromWorld.row[1], at) / z + p.centre;
            box.lowA = std::min(box.lowA, a), box.highA = std::max(box.highA, a);
            box.lowB = std::min(box.lowB, b), box.highB = std::max(box.highB, b);
            highest = std::max(highest, p.near / z);
        }
        boxes.push_back(box);
    }
    return boxes;
}

}  // namespace

std::vector<Shadowable> shadowableReceivers(const geometry::Mesh& mesh,
                                            const visibility::LightView& view,
                                            const std::vector<float>& receivers, int stride) {
    const auto& p = view.params;
    double highest = 0;
    const auto casters = casterBounds(mesh, p, highest);
    const double reachX = p.halfWidth * p.focal / p.near, reachY = p.halfHeight * p.focal / p.near;
    const double cell = 2.0 * p.resolution / OCCUPANCY_SIDE;
    std::vector<Shadowable> result;
    for (std::size_t i = 0; i < static_cast<std::size_t>(stride); ++i) {
        const auto at = [&](int plane) -> double {
            return receivers[static_cast<std::size_t>(plane * stride) + i];
        };
        const double farther = std::max(highest - at(RECEIVER_W), 0.0);
        const Box box{at(RECEIVER_A) - reachX * farther, at(RECEIVER_A) + reachX * farther,
                      at(RECEIVER_B) - reachY * farther, at(RECEIVER_B) + reachY * farther};
        const bool below = at(RECEIVER_FACING) <= std::abs(at(RECEIVER_GRADIENT_X)) * reachX +
                                                      std::abs(at(RECEIVER_GRADIENT_Y)) * reachY;
        Shadowable state = below ? Shadowable::yes : Shadowable::no;
        for (const auto& caster : casters) {
            if (caster.meets(box, 2))
                state = Shadowable::yes;
            else if (state == Shadowable::no && caster.meets(box, 3 + 2 * cell))
                state = Shadowable::near;
        }
        result.push_back(state);
    }
    return result;
}

}  // namespace penumbra::tests
