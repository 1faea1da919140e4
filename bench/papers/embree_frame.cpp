// SPDX-License-Identifier: MIT
#include "bench/papers/embree_frame.h"

#include <algorithm>
#include <cmath>

#include "bench/papers/embree_shadows.h"
#include "host/pipeline.h"
#include "kernels/shared/multi_view.h"
#include "runtime/error.h"

namespace penumbra::papers {
namespace {

/// Corners of all casters, world.
std::vector<glm::vec3> casterCorners(const scene::Scene& scene, const scene::Pose& pose) {
    std::vector<glm::vec3> corners;
    for (const int index : scene.order) {
        const auto& node = scene.nodes[static_cast<std::size_t>(index)];
        if (node.mesh < 0 || !node.castShadow) continue;
        const glm::dmat4& world = pose.worldFromNode[static_cast<std::size_t>(index)];
        for (const auto& p : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives)
            for (const auto vertex : p.indices)
                corners.emplace_back(world * glm::dvec4(glm::dvec3(p.positions[vertex]), 1));
    }
    return corners;
}

const std::vector<float>& planeOf(const Frame& frame, const std::string& name) {
    for (const auto& channel : frame.channels)
        if (channel.name == name) return channel.values;
    throw Error("the frame has no plane " + name);
}

std::vector<MaskScene::Receiver> receiversOf(const RenderOptions& options,
                                             const std::vector<glm::dvec3>& samples) {
    RenderOptions plain = options;
    plain.technique = "none";
    plain.settings.clear();
    plain.aovs = {"position", "normal", "depth"};
    Pipeline pipeline(plain);
    const Frame frame = pipeline.render(0);
    const auto vectorAt = [&](const char* name, std::size_t i) {
        const std::string stem = name;
        return glm::vec3(planeOf(frame, stem + ".X")[i], planeOf(frame, stem + ".Y")[i],
                         planeOf(frame, stem + ".Z")[i]);
    };
    const auto& depth = planeOf(frame, "Z");
    const auto offset = static_cast<float>(pipeline.bounds().radius()) * SHADOW_ORIGIN_OFFSET;
    std::vector<MaskScene::Receiver> receivers;
    for (std::size_t i = 0; i < depth.size(); ++i) {
        if (!std::isfinite(depth[i])) continue;
        const glm::vec3 place = vectorAt("P", i), normal = vectorAt("N", i);
        const bool faces = std::any_of(samples.begin(), samples.end(), [&](const auto& sample) {
            return glm::dot(normal, glm::vec3(sample) - place) > 0;
        });
        if (faces) receivers.push_back({place + normal * offset, normal, i});
    }
    return receivers;
}

}  // namespace

EmbreeFrame traceFrame(RenderOptions options, int columns, int rows) {
    options.lightSamples = fmt::format("{}x{}", columns, rows);
    options.lightPattern = "grid";
    const auto scene = loadScene(options);
    const auto pose = scene::poseAt(scene, {}, 0);
    const auto bounds = scene::clipBounds(scene, {});
    scene::SampleChoice choice;
    choice.pattern = scene::parsePattern(options.lightPattern);
    choice = scene::parseSampleCount(options.lightSamples, choice);
    const auto light = scene::lightsAt(scene, pose, bounds, choice).at(0);
    std::vector<glm::dvec3> samples;
    for (const auto& s : light.samples)
        samples.emplace_back(light.centre + s.x * light.axisX + s.y * light.axisY);
    const auto receivers = receiversOf(options, samples);
    const EmbreeShadows embree(casterCorners(scene, pose), false);
    EmbreeFrame frame;
    frame.rays = receivers.size() * samples.size();
    frame.threads = embree.threads();
    frame.ms = 1e3 * embree.trace(receivers, samples, columns, rows);
    for (int again = 0; again < 2; ++again)
        frame.ms = std::min(frame.ms, 1e3 * embree.trace(receivers, samples, columns, rows));
    return frame;
}

}  // namespace penumbra::papers
