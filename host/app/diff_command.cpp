// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>

#include "host/app/commands.h"
#include "host/metrics/image_error.h"
#include "runtime/error.h"

namespace penumbra::app {
namespace {

nlohmann::json errorJson(const metrics::ImageError& error) {
    nlohmann::json json = {
        {"pixels", error.pixels},
        {"rmse", error.rmse},
        {"max", error.maximum},
        {"mean", error.mean},
        {"share", {{"1", error.share[0]}, {"4", error.share[1]}, {"16", error.share[2]}}}};
    json["psnr"] = std::isfinite(error.psnr) ? nlohmann::json(error.psnr) : nlohmann::json("inf");
    return json;
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

bool exceedsShare(const std::string& limit, const metrics::ImageError& error) {
    const auto equals = limit.find('=');
    const std::string step = limit.substr(0, equals);
    const int index = step == "1" ? 0 : step == "4" ? 1 : step == "16" ? 2 : -1;
    double most = -1;
    try {
        if (equals != std::string::npos) most = std::stod(limit.substr(equals + 1));
    } catch (const std::exception&) {
    }
    requireUsage(index >= 0 && most >= 0,
                 "--fail-share {} is not STEP=SHARE; allowed steps: 1, 4, 16 (of 255)", limit);
    return error.share[static_cast<std::size_t>(index)] > most;
}

}  // namespace

int runDiff(const DiffArguments& arguments) {
    const auto a = image::readImage(arguments.a), b = image::readImage(arguments.b);
    const auto errors = metrics::compareImages(a, b, arguments.layer, readMask(arguments.mask));
    const auto& whole = errors[0].error;
    if (arguments.json) {
        auto json = errorJson(whole);
        json["layer"] = errors[0].layer;
        for (std::size_t i = 1; i < errors.size(); ++i)
            json["layers"][errors[i].layer] = errorJson(errors[i].error);
        fmt::print("{}\n", json.dump(2));
    } else {
        for (std::size_t i = errors.size() == 2 ? 1 : 0; i < errors.size(); ++i) {
            const auto& e = errors[i].error;
            fmt::print(
                "{}: rmse {:.6g}, max {:.6g}, mean {:.6g}, psnr {:.2f} dB, beyond 1/255 {:.4f}%, "
                "4/255 "
                "{:.4f}%, 16/255 {:.4f}% of {} pixels\n",
                errors[i].layer, e.rmse, e.maximum, e.mean, e.psnr, 100 * e.share[0],
                100 * e.share[1], 100 * e.share[2], e.pixels);
        }
    }
    bool beyond = (arguments.failRmse && whole.rmse > *arguments.failRmse) ||
                  (arguments.failMax && whole.maximum > *arguments.failMax) ||
                  (arguments.failPsnr && whole.psnr < *arguments.failPsnr);
    for (const auto& limit : arguments.failShares) beyond |= exceedsShare(limit, whole);
    if (beyond)
        fmt::print(stderr, "penumbra: {} and {} differ beyond the limit\n", arguments.a,
                   arguments.b);
    return static_cast<int>(beyond ? ExitCode::beyondLimit : ExitCode::done);
}

}  // namespace penumbra::app
