// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "host/app/commands.h"
#include "host/metrics/image_error.h"
#include "runtime/error.h"

namespace penumbra::app {
namespace {

nlohmann::json errorJson(const metrics::LayerError& layer) {
    const auto& error = layer.error;
    nlohmann::json json = {
        {"pixels", error.pixels},
        {"rmse", error.rmse},
        {"max", error.maximum},
        {"mean", error.mean},
        {"share", {{"1", error.share[0]}, {"4", error.share[1]}, {"16", error.share[2]}}}};
    json["psnr"] = std::isfinite(error.psnr) ? nlohmann::json(error.psnr) : nlohmann::json("inf");
    json["ssim"] = layer.ssim ? nlohmann::json(*layer.ssim) : nlohmann::json();
    json["flip"] = layer.flip ? nlohmann::json(*layer.flip) : nlohmann::json();
    return json;
}

void printError(const metrics::LayerError& layer) {
    const auto& e = layer.error;
    fmt::print("{}: rmse {:.6g}, max {:.6g}, mean {:.6g}, psnr {:.2f} dB, ", layer.layer, e.rmse,
               e.maximum, e.mean, e.psnr);
    if (layer.ssim && layer.flip)
        fmt::print("ssim {:.6g}, flip {:.6g}, ", *layer.ssim, *layer.flip);
    fmt::print("beyond 1/255 {:.4f}%, 4/255 {:.4f}%, 16/255 {:.4f}% of {} pixels\n",
               100 * e.share[0], 100 * e.share[1], 100 * e.share[2], e.pixels);
}

std::vector<bool> readMask(const std::string& path) {
    std::vector<bool> mask;
    if (path.empty()) return mask;
    const auto image = image::readImage(path);
    require(!image.channels.empty(), "{}: the mask has no channels", path);
    const auto* plane = image.find("R");
    if (!plane) plane = &image.channels[0].values;
    for (const float value : *plane) mask.push_back(value > 0.5F);
    return mask;
}

/// A limit on the share of pixels beyond a step of ImageError::share.
struct ShareLimit {
    std::size_t step;
    double most;
};

ShareLimit parseShare(const std::string& limit) {
    const std::string step = limit.substr(0, limit.find('='));
    const int index = step == "1" ? 0 : step == "4" ? 1 : step == "16" ? 2 : -1;
    double most = -1;
    const char* const end = limit.data() + limit.size();
    const char* const begin = std::min(limit.data() + step.size() + 1, end);
    const auto [stop, error] = std::from_chars(begin, end, most);
    requireUsage(index >= 0 && error == std::errc() && stop == end && most >= 0,
                 "--fail-share {} is not STEP=SHARE; allowed steps: 1, 4, 16 (of 255)", limit);
    return {static_cast<std::size_t>(index), most};
}

/// Also refuses NaN, beyond which nothing would be.
void requireRange(const char* option, double value, double least, double most) {
    requireUsage(value >= least && value <= most, "{} {} is outside of {} to {}", option, value,
                 least, most);
}

bool isBeyond(const DiffArguments& arguments, const metrics::LayerError& whole) {
    const auto& e = whole.error;
    bool beyond = (arguments.failRmse && e.rmse > *arguments.failRmse) ||
                  (arguments.failMax && e.maximum > *arguments.failMax) ||
                  (arguments.failPsnr && e.psnr < *arguments.failPsnr) ||
                  (arguments.failSsim && *whole.ssim < *arguments.failSsim) ||
                  (arguments.failFlip && *whole.flip > *arguments.failFlip);
    for (const auto& limit : arguments.failShares) {
        const auto [step, most] = parseShare(limit);
        beyond |= e.share[step] > most;
    }
    return beyond;
}

}  // namespace

int runDiff(const DiffArguments& arguments) {
    requireRange("--pixels-per-degree", arguments.pixelsPerDegree, 1, 1000);
    if (arguments.failSsim) requireRange("--fail-ssim", *arguments.failSsim, -1, 1);
    if (arguments.failFlip) requireRange("--fail-flip", *arguments.failFlip, 0, 1);
    for (const auto& limit : arguments.failShares) parseShare(limit);
    const auto a = image::readImage(arguments.a), b = image::readImage(arguments.b);
    const auto errors = metrics::compareImages(a, b, arguments.layer, readMask(arguments.mask),
                                               {arguments.pixelsPerDegree});
    const auto& whole = errors[0];
    requireUsage(whole.flip || (!arguments.failSsim && !arguments.failFlip),
                 "layer '{}' is no picture for --fail-ssim and --fail-flip; allowed: RGB, albedo, "
                 "visibility.*",
                 whole.layer);
    if (arguments.json) {
        auto json = errorJson(whole);
        json["layer"] = whole.layer;
        for (std::size_t i = 1; i < errors.size(); ++i)
            json["layers"][errors[i].layer] = errorJson(errors[i]);
        fmt::print("{}\n", json.dump(2));
    } else {
        for (std::size_t i = errors.size() == 2 ? 1 : 0; i < errors.size(); ++i)
            printError(errors[i]);
    }
    const bool beyond = isBeyond(arguments, whole);
    if (beyond)
        fmt::print(stderr, "penumbra: {} and {} differ beyond the limit\n", arguments.a,
                   arguments.b);
    return static_cast<int>(beyond ? ExitCode::beyondLimit : ExitCode::done);
}

}  // namespace penumbra::app
