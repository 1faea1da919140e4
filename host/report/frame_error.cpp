// SPDX-License-Identifier: MIT
#include "host/report/frame_error.h"

#include <algorithm>
#include <cmath>

#include "host/metrics/flip.h"
#include "host/metrics/image_error.h"
#include "host/metrics/ssim.h"

namespace penumbra::report {
namespace {

metrics::Picture pictureOf(const SeenFrame& frame) {
    metrics::Picture picture{frame.width, frame.height, metrics::Encoding::srgb, {}};
    for (std::size_t c = 0; c < 3; ++c) {
        metrics::Plane plane(frame.picture.size() / 3);
        for (std::size_t i = 0; i < plane.size(); ++i)
            plane[i] = static_cast<float>(frame.picture[3 * i + c]) / 255;
        picture.planes.push_back(std::move(plane));
    }
    return picture;
}

}  // namespace

std::vector<bool> pixelsThatCount(const SeenFrame& truth, const SeenFrame& frame) {
    const auto& mask = truth.mask.empty() ? frame.mask : truth.mask;
    const bool any = std::find(mask.begin(), mask.end(), true) != mask.end();
    return any ? mask : std::vector<bool>();
}

FrameError errorOf(const SeenFrame& truth, const SeenFrame& frame, const std::vector<bool>& mask,
                   metrics::Plane* flipMap) {
    FrameError error;
    const auto a = pictureOf(truth), b = pictureOf(frame);
    const auto whole = metrics::imageError({&a.planes[0], &a.planes[1], &a.planes[2]},
                                           {&b.planes[0], &b.planes[1], &b.planes[2]}, {});
    auto flip = metrics::flip(a, b);
    error.frameRmse255 = 255 * whole.rmse;
    error.frameFlip = flip.mean;
    error.frameSsim = metrics::ssim(a, b).mean;
    if (flipMap) *flipMap = std::move(flip.map);
    const bool visible = truth.visibility.size() == frame.visibility.size();
    const auto compared =
        visible ? metrics::imageError({&truth.visibility}, {&frame.visibility}, mask) : whole;
    error.rmse = compared.rmse;
    error.maximum = compared.maximum;
    error.mean = compared.mean;
    error.share4 = compared.share[1];
    error.flip = error.frameFlip;
    if (visible) {
        const auto grey = [](const SeenFrame& f) {
            return metrics::Picture{f.width, f.height, metrics::Encoding::linear, {f.visibility}};
        };
        error.flip = metrics::flip(grey(truth), grey(frame), mask).mean;
    }
    return error;
}

void add(FrameError& sum, const FrameError& e) {
    sum.rmse += e.rmse;
    sum.maximum = std::max(sum.maximum, e.maximum);
    sum.mean += e.mean;
    sum.share4 += e.share4;
    sum.flip += e.flip;
    sum.frameRmse255 += e.frameRmse255;
    sum.frameFlip += e.frameFlip;
    sum.frameSsim += e.frameSsim;
}

FrameError scaled(FrameError e, double factor) {
    for (double* value :
         {&e.rmse, &e.mean, &e.share4, &e.flip, &e.frameRmse255, &e.frameFlip, &e.frameSsim})
        *value *= factor;
    return e;
}

std::optional<double> flickerOf(const SeenFrame& last, const SeenFrame& now,
                                const std::vector<bool>& resting) {
    if (last.visibility.size() != now.visibility.size() || now.visibility.empty())
        return std::nullopt;
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < now.visibility.size(); ++i) {
        if (!resting[i]) continue;
        sum += std::abs(now.visibility[i] - last.visibility[i]);
        ++count;
    }
    return count > 0 ? std::optional(sum / count) : std::nullopt;
}

std::vector<bool> restingPixels(const SeenFrame& last, const SeenFrame& now) {
    const std::size_t pixels = now.mask.size();
    std::vector<bool> resting(pixels, false);
    if (last.positions.size() != 3 * pixels || now.positions.size() != 3 * pixels) return resting;
    for (std::size_t i = 0; i < pixels; ++i) {
        bool same = now.mask[i] && last.mask[i];
        for (std::size_t axis = 0; axis < 3 && same; ++axis) {
            const float a = last.positions[axis * pixels + i], b = now.positions[axis * pixels + i];
            same = std::abs(a - b) <= 1e-5F * (1 + std::abs(a));
        }
        resting[i] = same;
    }
    return resting;
}

}  // namespace penumbra::report
