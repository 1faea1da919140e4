// SPDX-License-Identifier: MIT
// The passes of a pipeline: the plan of their memory, and how they are made.
#include <algorithm>

#include "host/pipeline.h"
#include "runtime/error.h"
#include "runtime/memory_plan.h"
#include "runtime/self_test.h"
#include "runtime/slow_notice.h"

namespace penumbra {
namespace {

constexpr int kMaxAttempts = 7;
constexpr double kMaxMegapixels = 90;

}  // namespace

void Pipeline::planScene() const {
    runtime::MemoryPlan plan(*device_);
    // Kernels index all planes of an image with 32 bits
    const double millions = static_cast<double>(width_) * height_ / 1e6;
    if (millions > kMaxMegapixels)
        throw Error(
            fmt::format(
                "out of memory: {:.0f} million pixels with supersampling, at most {:.0f} million "
                "fit; use a smaller --size or --supersample",
                millions, kMaxMegapixels),
            ExitCode::outOfMemory);
    const auto pixels = static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(height_);
    plan.add("G-buffer", pixels * GB_PLANES * sizeof(float));
    plan.add("visibility buffer", pixels * 8);
    plan.add("colour and visibility", pixels * 5 * sizeof(float));
    if (options_.temporal > 1)
        plan.add("visibility history",
                 2ULL * static_cast<std::uint64_t>(options_.temporal) * pixels * sizeof(float));
    plan.add(options_.technique, visibility::findTechnique(options_.technique)
                                     .plannedBytes({*device_, options_.settings, width_, height_}));
    plan.check();
}

std::uint64_t Pipeline::planFrame() const {
    runtime::MemoryPlan plan(*device_);
    const auto& mesh = geometry_->mesh();
    plan.addHeld("scene and images");
    plan.add(fmt::format("lists and maps of {}", options_.technique), technique_->frameBytes(mesh));
    if (maskBytes_ > 0) plan.add("occlusion masks", maskBytes_);
    const auto lights = std::max<std::size_t>(scene_.lights.size(), 1);
    if (options_.temporal > 1)
        plan.add("visibility history",
                 2ULL * static_cast<std::uint64_t>(options_.temporal - 1) * lights *
                     static_cast<std::uint64_t>(technique_->channels(mesh)) *
                     static_cast<std::uint64_t>(gbuffer_->result().planeStride) * sizeof(float));
    plan.check();
    return plan.plannedBytes();
}

void Pipeline::makePasses() {
    program_ = std::make_unique<runtime::Program>(*device_, "frame");
    runtime::selfTest(*program_);
    geometry_ = std::make_unique<geometry::Geometry>(*program_, scene_, bounds_.centre());
    gbuffer_ = std::make_unique<gbuffer::GBufferPass>(*program_, width_, height_);
    if (geometry_->mesh().hasBlend) {
        composite_ = std::make_unique<shading::Composite>(*program_, width_, height_);
        sizeLists();
    }
    makeForPixels();
    temporal_ = std::make_unique<shading::Temporal>(*program_, width_, height_, options_.temporal);
    requireUsage(!aovs_.depthMaps || technique_->hasDepthMaps(),
                 "--aov depth-maps: technique {} makes none; vwss, mvr, mvss, pcss and essm do",
                 options_.technique);
}

void Pipeline::dropPasses() {
    device_->profiler().discard();
    visibility_ = {};
    madeForRows_ = 0;
    composite_ = nullptr;
    temporal_ = nullptr;
    shade_ = nullptr;
    technique_ = nullptr;
    gbuffer_ = nullptr;
    geometry_ = nullptr;
    lastFrame_.reset();
}

void Pipeline::sizeLists() {
    const runtime::SlowNotice notice("preparing kernels for their first use on this device");
    const scene::Pose pose = scene::poseAt(scene_, clips_, 0);
    const auto camera = cameraOf(pose);
    const geometry::Mesh& mesh = geometry_->run(pose);
    int attempts = 0;
    do {
        require(attempts++ < kMaxAttempts, "device lists still overflow after {} attempts",
                kMaxAttempts);
        gbuffer_->run(mesh, camera, bounds_.centre());
    } while (gbuffer_->grew());
    device_->profiler().collect();
}

void Pipeline::makeForPixels() {
    const auto& gbuffer = gbuffer_->result();
    if (madeForRows_ == gbuffer.rows()) return;
    // Free first: both at once may not fit
    technique_ = nullptr;
    shade_ = nullptr;
    visibility_ = {};
    technique_ =
        visibility::findTechnique(options_.technique)
            .make({*device_, options_.settings, width_, gbuffer.rows(), gbuffer.fragmentRows});
    shade_ = std::make_unique<shading::Shade>(*program_, width_, gbuffer.rows());
    const auto pixels = static_cast<std::uint64_t>(gbuffer.planeStride);
    const auto channels = static_cast<std::uint64_t>(technique_->channels(geometry_->mesh()));
    visibility_.planes =
        runtime::Buffer<float>(*device_, "visibility", runtime::Shape{1, channels, pixels});
    visibility_.state = runtime::Buffer<std::uint32_t>(*device_, "pixel states", pixels);
    madeForRows_ = gbuffer.rows();
}

}  // namespace penumbra
