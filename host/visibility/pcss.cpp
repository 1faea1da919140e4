// SPDX-License-Identifier: MIT
#include "host/visibility/pcss.h"

#include <cmath>

#include "host/scene/poisson_disk.h"
#include "host/visibility/single_view.h"

namespace penumbra::visibility {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kGoldenAngle = 2.39996322972865332;
constexpr float kLeastTexels =
    0.75F;  // of the filter: the edge of a contact shadow is a texel wide

/// Points of the unit disk, evenly spread: Vogel's spiral or Bridson's Poisson disk.
std::vector<float> diskPattern(DiskPattern pattern, int count) {
    std::vector<float> points;
    if (pattern == DiskPattern::poisson) {
        for (const auto& p : scene::poissonDisk(count, true, 0)) {
            points.push_back(static_cast<float>(p.x));
            points.push_back(static_cast<float>(p.y));
        }
        return points;
    }
    for (int i = 0; i < count; ++i) {
        const double r = std::sqrt((i + 0.5) / count), angle = i * kGoldenAngle;
        points.push_back(static_cast<float>(r * std::cos(angle)));
        points.push_back(static_cast<float>(r * std::sin(angle)));
    }
    return points;
}

/// A rotation for each pixel of a 16 x 16 tile, neighbours far apart: Jimenez' interleaved
/// gradient.
std::vector<float> tileRotations(bool rotate) {
    std::vector<float> rotations;
    for (int i = 0; i < PCSS_ROTATIONS; ++i) {
        const int column = i % 16, row = i / 16;
        const double inner = 0.06711056 * column + 0.00583715 * row;
        const double noise = 52.9829189 * (inner - std::floor(inner));
        const double angle = rotate ? 2 * kPi * (noise - std::floor(noise)) : 0;
        rotations.push_back(static_cast<float>(std::cos(angle)));
        rotations.push_back(static_cast<float>(std::sin(angle)));
    }
    return rotations;
}

std::vector<float> patternsOf(const PcssSettings& settings) {
    auto points = diskPattern(settings.pattern, settings.blockerTaps);
    const auto filter = diskPattern(settings.pattern, settings.filterTaps);
    points.insert(points.end(), filter.begin(), filter.end());
    return points;
}

}  // namespace

PcssReader::PcssReader(const runtime::Program& program, const PcssSettings& settings)
    : device_(&program.device()),
      settings_(settings),
      pcss_(program, "pcss"),
      patterns_(*device_, "disk patterns", patternsOf(settings)),
      rotations_(*device_, "pattern rotations", tileRotations(settings.rotate)) {}

void PcssReader::read(const LightView& view, const MapBatch& batch, ReceiverImage& receivers) {
    const auto& p = view.params;
    shared::LookupParams bias{};
    applyBias(settings_, bias);
    shared::PcssParams params{};
    params.blockerTaps = settings_.blockerTaps;
    params.filterTaps = settings_.filterTaps;
    // A rectangle becomes the ellipse of its area
    const float rim = view.disk ? 1.0F : static_cast<float>(2 / std::sqrt(kPi));
    params.reachX = rim * p.halfWidth * p.focal / p.near;
    params.reachY = rim * p.halfHeight * p.focal / p.near;
    params.leastSpread = kLeastTexels / std::max({params.reachX, params.reachY, 1e-6F});
    params.receiverWidth = receivers.width;
    params.planeBias = settings_.planeBias ? 1 : 0;
    const runtime::Range items{
        static_cast<std::uint64_t>(receivers.stride / device_->info().lanes)};
    pcss_.launch(items, {64}, p, bias, params, receivers.stride, receivers.planes, patterns_,
                 rotations_, *batch.maps32, receivers.hidden);
}

Pcss::Pcss(const TechniqueContext& context)
    : settings_(parseSettings<PcssSettings>("pcss", context.values)),
      shared_(context.device, "multi_view"),
      maps_(context.device, "mvr"),
      program_(context.device, "pcss"),
      multiView_(shared_, settings_, context.width, context.height, context.fragmentRows),
      source_(maps_, {MapForm::textbook, Coverage::standard, settings_.cull}),  // one map
      reader_(program_, settings_) {}

std::uint64_t Pcss::plannedBytes(const TechniqueContext& context) {
    return MultiView::plannedBytes(parseSettings<PcssSettings>("pcss", context.values),
                                   context.width, context.height);
}

void Pcss::run(const Inputs& inputs, Visibility& visibility) {
    multiView_.run(inputs, centralView(inputs.light), source_, reader_, visibility);
}

Counts Pcss::takeCounts() {
    Counts counts = multiView_.takeCounts();
    counts.mapTriangles = source_.takeTriangles();
    return counts;
}

}  // namespace penumbra::visibility
