// SPDX-License-Identifier: MIT
#include "bench/papers/embree_shadows.h"

#include <embree3/rtcore.h>
#include <immintrin.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "runtime/error.h"

namespace penumbra::papers {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What differs between packets of 8 and of 16 rays: 4 x 2 and 4 x 4 light samples.
struct Packet8 {
    static constexpr int kRays = 8, kRows = 2;
    using Ray = RTCRay8;
    static void occluded(const int* valid, RTCScene scene, RTCIntersectContext* context,
                         Ray* rays) {
        rtcOccluded8(valid, scene, context, rays);
    }
};
struct Packet16 {
    static constexpr int kRays = 16, kRows = 4;
    using Ray = RTCRay16;
    static void occluded(const int* valid, RTCScene scene, RTCIntersectContext* context,
                         Ray* rays) {
        rtcOccluded16(valid, scene, context, rays);
    }
};

struct Job {
    const std::vector<MaskScene::Receiver>& receivers;
    const std::vector<glm::dvec3>& samples;
    int columns, rows;
    std::vector<std::uint32_t>* hidden;
};

template <typename Packet>
void traceBlock(RTCScene scene, const Job& job, std::size_t index, int column, int row,
                std::uint32_t* bits) {
    const auto& r = job.receivers[index];
    alignas(64) int valid[Packet::kRays];
    alignas(64) typename Packet::Ray rays;
    bool any = false;
    for (int lane = 0; lane < Packet::kRays; ++lane) {
        const int x = column + lane % 4, y = row + lane / 4;
        const bool inside = x < job.columns && y < job.rows;
        const auto sample = static_cast<std::size_t>(inside ? y * job.columns + x : 0);
        const glm::vec3 d(job.samples[sample] - glm::dvec3(r.origin));
        const bool above = inside && glm::dot(d, r.normal) > 0;
        if (inside && !above && bits) bits[sample / 32] |= 1U << (sample % 32);
        valid[lane] = above ? -1 : 0;
        any = any || above;
        rays.org_x[lane] = r.origin.x, rays.org_y[lane] = r.origin.y, rays.org_z[lane] = r.origin.z;
        rays.dir_x[lane] = d.x, rays.dir_y[lane] = d.y, rays.dir_z[lane] = d.z;
        rays.tnear[lane] = 0, rays.tfar[lane] = 1, rays.time[lane] = 0;
        rays.mask[lane] = ~0U, rays.id[lane] = 0, rays.flags[lane] = 0;
    }
    if (!any) return;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    Packet::occluded(valid, scene, &context, &rays);
    if (!bits) return;
    for (int lane = 0; lane < Packet::kRays; ++lane) {
        if (!valid[lane] || rays.tfar[lane] >= 0) continue;
        const int sample = (row + lane / 4) * job.columns + column + lane % 4;
        bits[sample / 32] |= 1U << (sample % 32);
    }
}

template <typename Packet>
double traceAll(RTCScene scene, const Job& job, int threads) {
    const std::size_t words = (job.samples.size() + 31) / 32;
    std::atomic<std::size_t> next{0};
    constexpr std::size_t kChunk = 256;
    const auto work = [&] {
        _mm_setcsr(_mm_getcsr() | 0x8040);  // denormals are zero, as Embree asks for
        for (std::size_t first; (first = next.fetch_add(kChunk)) < job.receivers.size();)
            for (std::size_t i = first; i < std::min(first + kChunk, job.receivers.size()); ++i) {
                std::uint32_t* bits = job.hidden ? job.hidden->data() + i * words : nullptr;
                for (int row = 0; row < job.rows; row += Packet::kRows)
                    for (int column = 0; column < job.columns; column += 4)
                        traceBlock<Packet>(scene, job, i, column, row, bits);
            }
    };
    const auto start = Clock::now();
    std::vector<std::thread> others;
    for (int t = 1; t < threads; ++t) others.emplace_back(work);
    work();
    for (auto& thread : others) thread.join();
    return secondsSince(start);
}

}  // namespace

struct EmbreeShadows::Handles {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
};

EmbreeShadows::EmbreeShadows(const std::vector<glm::vec3>& corners, bool robust)
    : handles_(std::make_unique<Handles>()) {
    auto& h = *handles_;
    h.device = rtcNewDevice(fmt::format("threads={}", threads()).c_str());
    const auto start = Clock::now();
    h.scene = rtcNewScene(h.device);
    rtcSetSceneBuildQuality(h.scene, RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(h.scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    const RTCGeometry geometry = rtcNewGeometry(h.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), corners.size()));
    auto* indices = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), corners.size() / 3));
    for (std::size_t i = 0; i < corners.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis)
            vertices[3 * i + static_cast<std::size_t>(axis)] = corners[i][axis];
        indices[i] = static_cast<unsigned>(i);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(h.scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(h.scene);
    buildSeconds_ = secondsSince(start);
}

EmbreeShadows::~EmbreeShadows() {
    rtcReleaseScene(handles_->scene);
    rtcReleaseDevice(handles_->device);
}

int EmbreeShadows::threads() const {
    return static_cast<int>(std::max(std::thread::hardware_concurrency(), 1U));
}

double EmbreeShadows::trace(const std::vector<MaskScene::Receiver>& receivers,
                            const std::vector<glm::dvec3>& samples, int columns, int rows,
                            std::vector<std::uint32_t>* hidden) const {
    if (hidden) hidden->assign(receivers.size() * ((samples.size() + 31) / 32), 0);
    const Job job{receivers, samples, columns, rows, hidden};
    if (hidden) return traceAll<Packet16>(handles_->scene, job, threads());
    return std::min(traceAll<Packet8>(handles_->scene, job, threads()),
                    traceAll<Packet16>(handles_->scene, job, threads()));
}

}  // namespace penumbra::papers
