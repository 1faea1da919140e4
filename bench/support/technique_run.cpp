// SPDX-License-Identifier: MIT
#include "bench/support/technique_run.h"

#include <algorithm>

#include "kernels/shared/multi_view.h"

namespace penumbra::bench {
namespace {

constexpr int kWidth = 1280, kHeight = 720;

scene::Scene walls() {
    scene::Scene scene;
    scene.materials.emplace_back();
    scene::Primitive p;
    // Quads of 4 x 4 m facing up, from 0 (the floor) to 1.2 m
    for (int layer = 0; layer <= 12; ++layer) {
        const auto base = static_cast<std::uint32_t>(p.positions.size());
        const float y = 0.1F * static_cast<float>(layer);
        for (const glm::vec3 v :
             {glm::vec3(-2, y, 2), glm::vec3(2, y, 2), glm::vec3(2, y, -2), glm::vec3(-2, y, -2)}) {
            p.positions.push_back(v);
            p.normals.emplace_back(0, 1, 0);
            p.uvs[0].emplace_back(0, 0);
        }
        for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U}) p.indices.push_back(base + i);
    }
    scene.meshes.push_back({"walls", {p}, {}});
    scene::Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    scene.order = {0};
    scene.lights = {scene::parseLight("rect:at=0,6,0;aim=0,0,0;up=0,0,1;size=1x1;radiance=10")};
    return scene;
}

}  // namespace

PosedScene& wallScene() {
    static auto& posed = *[] {
        auto* p = new PosedScene;
        p->scene = walls();
        p->bounds = scene::clipBounds(p->scene, {});
        p->geometry =
            std::make_unique<geometry::Geometry>(program("frame"), p->scene, p->bounds.centre());
        p->geometry->run(scene::poseAt(p->scene, {}, 0));
        return p;
    }();
    return posed;
}

TechniqueRun::TechniqueRun(PosedScene& posed, const std::string& technique,
                           const SettingValues& settings, int samples, scene::Pattern pattern)
    : posed_(&posed), pass_(program("frame"), kWidth, kHeight) {
    const auto pose = scene::poseAt(posed.scene, scene::chooseAnimations(posed.scene, ""), 0.25);
    scene::SampleChoice choice;
    choice.count = samples;
    choice.pattern = pattern;
    light_ = scene::lightsAt(posed.scene, pose, posed.bounds, choice).at(0);
    const auto camera = scene::cameraAt(posed.scene, pose, {}, posed.bounds, 16.0 / 9);
    do pass_.run(posed.mesh(), camera, posed.bounds.centre());
    while (pass_.grew());
    const auto& gbuffer = pass_.result();
    technique_ = visibility::findTechnique(technique).make(
        {device(), settings, kWidth, gbuffer.rows(), gbuffer.fragmentRows});
    const auto stride = static_cast<std::uint64_t>(pass_.result().planeStride);
    visibility_.planes = runtime::Buffer<float>(device(), "visibility", 3 * stride);
    visibility_.state = runtime::Buffer<std::uint32_t>(device(), "states", stride);
    for (enqueue(); technique_->grew(); enqueue()) technique_->takeCounts();
    technique_->takeCounts();
    const auto states = visibility_.state.download();
    tested_ = std::count(states.begin(), states.end(), STATE_TESTED);
    device().profiler().collect();
}

void TechniqueRun::enqueue() {
    technique_->prepare(posed_->mesh(), posed_->bounds, posed_->bounds.centre());
    technique_->run(
        {posed_->mesh(), pass_.result(), light_, posed_->bounds, posed_->bounds.centre()},
        visibility_);
}

std::map<std::string, double> TechniqueRun::stages() {
    enqueue();
    std::map<std::string, double> ms;
    for (const auto& stage : device().profiler().collect()) ms[stage.name] += stage.deviceMs;
    counts_ = technique_->takeCounts();
    device().profiler().collect();
    return ms;
}

}  // namespace penumbra::bench
