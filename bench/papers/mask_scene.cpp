// SPDX-License-Identifier: MIT
#include "bench/papers/mask_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "host/scene/camera.h"
#include "host/scene/gltf_loader.h"
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/multi_view.h"
#include "runtime/profiler.h"

namespace penumbra::papers {
namespace {

/// The file's camera, turned about the vertical axis through the centre.
scene::CameraFrame turned(const scene::CameraFrame& camera, const glm::dvec3& centre, double rad) {
    if (rad == 0) return camera;
    scene::CameraFrame result = camera;
    const glm::dmat4 turn = glm::translate(glm::dmat4(1), centre) *
                            glm::rotate(glm::dmat4(1), rad, glm::dvec3(0, 1, 0)) *
                            glm::translate(glm::dmat4(1), -centre);
    result.worldFromCamera = turn * camera.worldFromCamera;
    return result;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

MaskScene::MaskScene(runtime::Device& device, const std::string& file, const MaskView& view)
    : device_(&device),
      scene_(scene::loadGltf(file)),
      bounds_(scene::clipBounds(scene_, scene::chooseAnimations(scene_, ""))),
      frame_(device, "frame"),
      geometry_(frame_, scene_, bounds_.centre()),
      pass_(frame_, view.size, view.size),
      size_(view.size) {
    const auto pose = scene::poseAt(scene_, scene::chooseAnimations(scene_, ""), view.seconds);
    light_ = scene::lightsAt(scene_, pose, bounds_, {}).at(0);
    light_.width *= view.lightScale;
    light_.height *= view.lightScale;
    scene::placeSamples(scene::parseSampleCount(view.samples, {}), light_);
    const auto camera =
        turned(scene::cameraAt(scene_, pose, {}, bounds_, 1), bounds_.centre(), view.turnRad);
    const auto& mesh = geometry_.run(pose);
    do pass_.run(mesh, camera, bounds_.centre());
    while (pass_.grew());
    const auto stride = static_cast<std::uint64_t>(pass_.result().planeStride);
    visibility_.planes = runtime::Buffer<float>(device, "visibility", 3 * stride);
    visibility_.state = runtime::Buffer<std::uint32_t>(device, "states", stride);
    device.profiler().collect();
}

std::map<std::string, double> MaskScene::run(const std::string& name, const SettingValues& settings,
                                             int repeats, visibility::OcclusionMasks* masks) {
    const auto technique = visibility::findTechnique(name).make({*device_, settings, size_, size_});
    const auto& mesh = geometry_.mesh();
    const auto enqueue = [&](visibility::OcclusionMasks* kept) {
        technique->prepare(mesh, bounds_, bounds_.centre());
        technique->run({mesh, pass_.result(), light_, bounds_, bounds_.centre(), nullptr, kept},
                       visibility_);
    };
    do enqueue(masks);
    while (technique->grew());
    device_->profiler().collect();
    std::map<std::string, std::vector<double>> times;
    for (int i = 0; i < repeats; ++i) {
        enqueue(nullptr);
        technique->grew();
        for (const auto& stage : device_->profiler().collect())
            if (stage.launches > 0) times[stage.name].push_back(stage.wallMs);
    }
    std::map<std::string, double> result;
    for (const auto& [stage, values] : times) result[stage] = median(values);
    return result;
}

std::vector<glm::vec3> MaskScene::corners() const {
    const auto& mesh = geometry_.mesh();
    const auto positions = mesh.positions.download();
    const auto indices = mesh.indices.download();
    const auto triangleDraw = mesh.triangleDraw.download();
    const auto draws = mesh.draws.download();
    std::vector<glm::vec3> corners;
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (!(draws[triangleDraw[i / 3]].flags & DRAW_CASTS)) continue;
        const std::size_t v = 3 * static_cast<std::size_t>(indices[i]);
        corners.emplace_back(positions[v], positions[v + 1], positions[v + 2]);
    }
    return corners;
}

std::vector<MaskScene::Receiver> MaskScene::receivers() const {
    const auto planes = pass_.result().planes.download();
    const auto state = visibility_.state.download();
    const auto stride = static_cast<std::size_t>(pass_.result().planeStride);
    std::vector<Receiver> result;
    for (std::size_t i = 0; i < static_cast<std::size_t>(size_ * size_); ++i) {
        if (state[i] != STATE_TESTED) continue;
        const auto vectorAt = [&](std::size_t plane) {
            return glm::vec3(planes[plane * stride + i], planes[(plane + 1) * stride + i],
                             planes[(plane + 2) * stride + i]);
        };
        const glm::vec3 p = vectorAt(GB_POSITION), n = vectorAt(GB_GEOMETRIC), s = glm::abs(p);
        const float magnitude = std::max({s.x, s.y, s.z, static_cast<float>(radius())});
        result.push_back({p + n * (magnitude * SHADOW_ORIGIN_OFFSET), n, i});
    }
    return result;
}

std::vector<glm::dvec3> MaskScene::samplePoints() const {
    std::vector<glm::dvec3> points;
    for (const auto& s : light_.samples)
        points.emplace_back(light_.centre - bounds_.centre() + s.x * light_.axisX +
                            s.y * light_.axisY);
    return points;
}

}  // namespace penumbra::papers
