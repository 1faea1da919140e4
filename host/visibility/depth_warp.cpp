// SPDX-License-Identifier: MIT
#include "host/visibility/depth_warp.h"

#include <algorithm>

namespace penumbra::visibility {

DepthWarp::DepthWarp(const runtime::Program& multiView, Parallelism parallelism, int viewsPerPass)
    : device_(&multiView.device()),
      parallelism_(parallelism),
      viewsPerPass_(viewsPerPass),
      warp_(multiView, "depth_warp"),
      owned_(multiView, "depth_warp_owned"),
      owned16_(multiView, "depth_warp_owned16") {
    if (parallelism_ == Parallelism::automatic)
        parallelism_ = device_->info().isCpu ? Parallelism::owned : Parallelism::full;
}

int DepthWarp::viewsPerLaunch(int batch) const {
    if (parallelism_ == Parallelism::serial) return 1;
    if (parallelism_ == Parallelism::partial) return std::min(viewsPerPass_, batch);
    return batch;
}

void DepthWarp::run(const PointBuffers& points, const LightView& view, const Buffer<float>& samples,
                    const MapBatch& batch, const Buffer<shared::MultiViewCounters>& counters) {
    shared::LookupParams views{};
    views.firstView = views.mapView = batch.firstView;
    views.viewCount = batch.viewCount;
    if (parallelism_ == Parallelism::owned) {
        const runtime::Range items{static_cast<std::uint64_t>(batch.viewCount)};
        if (batch.maps16)
            owned16_.launch(items, {1}, view.params, views, points.points32, points.points16,
                            points.keys, samples, *batch.maps16, counters);
        else
            owned_.launch(items, {1}, view.params, views, points.points32, points.points16,
                          points.keys, samples, *batch.maps32, counters);
        return;
    }
    batch.maps32->fill(0, static_cast<std::uint64_t>(view.params.mapStride) *
                              static_cast<std::uint64_t>(batch.viewCount));
    const auto& info = device_->info();
    const std::uint64_t items =
        static_cast<std::uint64_t>(info.computeUnits) * (info.isCpu ? 1024 : 2048);
    const int step = viewsPerLaunch(batch.viewCount);
    for (int first = 0; first < batch.viewCount; first += step) {
        views.firstView = batch.firstView + first;
        views.viewCount = std::min(step, batch.viewCount - first);
        warp_.launch({items}, {64}, view.params, views, points.points32, points.points16,
                     points.keys, samples, *batch.maps32, counters);
    }
}

}  // namespace penumbra::visibility
