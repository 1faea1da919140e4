// SPDX-License-Identifier: MIT
// Evaluates animations in double precision; glTF 2.0 section 3.11 and appendix C.
#include "host/scene/animation.h"

#include <algorithm>
#include <charconv>
#include <glm/gtc/matrix_transform.hpp>

#include "runtime/error.h"

namespace penumbra::scene {

namespace {

struct Local {
    glm::dvec3 translation, scale;
    glm::dquat rotation;
};

/// Where a time falls among a channel's keys: share 0 is key `from`, 1 key `to`.
struct Span {
    std::size_t from, to;
    double share, seconds;  ///< seconds between the keys
};

Span findSpan(const std::vector<float>& times, double seconds) {
    const auto after = std::upper_bound(times.begin(), times.end(), seconds,
                                        [](double time, float key) { return time < key; });
    if (after == times.begin()) return {0, 0, 0, 0};
    const auto to = static_cast<std::size_t>(after - times.begin());
    if (after == times.end()) return {to - 1, to - 1, 0, 0};
    const double begin = times[to - 1], length = static_cast<double>(times[to]) - begin;
    return {to - 1, to, (seconds - begin) / length, length};
}

/// One component of the channel at the span; rotations by LINEAR are not done here.
double interpolate(const Channel& channel, const Span& span, std::size_t width,
                   std::size_t component) {
    const bool cubic = channel.interpolation == Interpolation::cubicSpline;
    const auto part = [&](std::size_t key, std::size_t which) -> double {
        return channel.values[(cubic ? 3 * key + which : key) * width + component];
    };
    const double from = part(span.from, 1), to = part(span.to, 1), t = span.share;
    if (channel.interpolation == Interpolation::step || span.from == span.to) return from;
    if (!cubic) return from + t * (to - from);
    // Hermite: the out-tangent of the earlier key, the in-tangent of the later one, per second
    const double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * from + span.seconds * (t3 - 2 * t2 + t) * part(span.from, 2) +
           (3 * t2 - 2 * t3) * to + span.seconds * (t3 - t2) * part(span.to, 0);
}

glm::dquat normalizeOrIdentity(const glm::dquat& rotation) {
    const double length = glm::length(rotation);
    return length > 1e-12 ? rotation / length : glm::dquat(1, 0, 0, 0);
}

glm::dquat keyRotation(const Channel& channel, std::size_t key) {
    const float* const xyzw = &channel.values[4 * key];
    return normalizeOrIdentity(glm::dquat(xyzw[3], xyzw[0], xyzw[1], xyzw[2]));
}

glm::dquat rotationAt(const Channel& channel, const Span& span) {
    if (channel.interpolation == Interpolation::linear)  // glm's slerp goes the shorter way
        return normalizeOrIdentity(
            glm::slerp(keyRotation(channel, span.from), keyRotation(channel, span.to), span.share));
    return normalizeOrIdentity({interpolate(channel, span, 4, 3), interpolate(channel, span, 4, 0),
                                interpolate(channel, span, 4, 1),
                                interpolate(channel, span, 4, 2)});
}

void apply(const Channel& channel, double seconds, Local& local, std::vector<float>& weights) {
    const Span span = findSpan(channel.times, seconds);
    if (channel.path == Path::weights) {
        for (std::size_t i = 0; i < weights.size(); ++i)
            weights[i] = static_cast<float>(interpolate(channel, span, weights.size(), i));
        return;
    }
    if (channel.path == Path::rotation) {
        local.rotation = rotationAt(channel, span);
        return;
    }
    glm::dvec3& vector = channel.path == Path::translation ? local.translation : local.scale;
    for (std::size_t i = 0; i < 3; ++i)
        vector[static_cast<int>(i)] = interpolate(channel, span, 3, i);
}

glm::dmat4 parentFromNode(const Node& node, const Local& local) {
    if (node.usesMatrix) return node.matrix;
    return glm::scale(
        glm::translate(glm::dmat4(1), local.translation) * glm::mat4_cast(local.rotation),
        local.scale);
}

/// Clip 0, then each clip that moves none of the nodes moved so far.
std::vector<int> chooseDisjoint(const Scene& scene) {
    std::vector<int> chosen;
    std::vector<bool> moved(scene.nodes.size(), false);
    for (std::size_t clip = 0; clip < scene.animations.size(); ++clip) {
        const std::vector<Channel>& channels = scene.animations[clip].channels;
        const bool disjoint = std::none_of(
            channels.begin(), channels.end(),
            [&](const Channel& channel) { return moved[static_cast<std::size_t>(channel.node)]; });
        if (clip > 0 && !disjoint) continue;
        chosen.push_back(static_cast<int>(clip));
        for (const Channel& channel : channels)
            moved[static_cast<std::size_t>(channel.node)] = true;
    }
    return chosen;
}

std::string listClips(const Scene& scene) {
    std::string list;
    for (std::size_t i = 0; i < scene.animations.size(); ++i)
        list += fmt::format("{}{} \"{}\"", i == 0 ? "" : ", ", i, scene.animations[i].name);
    return list.empty() ? "the scene has no clips" : "the clips are " + list;
}

}  // namespace

double Animation::durationSeconds() const {
    double duration = 0;
    for (const Channel& channel : channels)
        duration = std::max(duration, static_cast<double>(channel.times.back()));
    return duration;
}

std::vector<int> chooseAnimations(const Scene& scene, const std::string& choice) {
    if (choice.empty() || choice == "all") return chooseDisjoint(scene);
    if (choice == "none") return {};
    for (std::size_t i = 0; i < scene.animations.size(); ++i)
        if (scene.animations[i].name == choice) return {static_cast<int>(i)};
    int index = -1;
    const auto [end, error] = std::from_chars(choice.data(), choice.data() + choice.size(), index);
    const bool isIndex = error == std::errc() && end == choice.data() + choice.size() &&
                         index >= 0 && static_cast<std::size_t>(index) < scene.animations.size();
    requireUsage(isIndex,
                 "animation '{}' is not in the scene: {}; 'all' and 'none' are allowed too", choice,
                 listClips(scene));
    return {index};
}

double clipDurationSeconds(const Scene& scene, const std::vector<int>& clips) {
    double duration = 0;
    for (const int clip : clips)
        duration =
            std::max(duration, scene.animations[static_cast<std::size_t>(clip)].durationSeconds());
    return duration;
}

Pose poseAt(const Scene& scene, const std::vector<int>& clips, double seconds) {
    const std::size_t count = scene.nodes.size();
    Pose pose{std::vector<glm::dmat4>(count, glm::dmat4(1)), {}};
    pose.weights.resize(count);
    std::vector<Local> locals(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Node& node = scene.nodes[i];
        locals[i] = {node.translation, node.scale, node.rotation};
        if (node.mesh < 0) continue;
        pose.weights[i] = node.weights.empty()
                              ? scene.meshes[static_cast<std::size_t>(node.mesh)].weights
                              : node.weights;
    }
    for (const int clip : clips)
        for (const Channel& channel : scene.animations[static_cast<std::size_t>(clip)].channels) {
            const auto node = static_cast<std::size_t>(channel.node);
            apply(channel, seconds, locals[node], pose.weights[node]);
        }
    for (const int index : scene.order) {
        const auto at = static_cast<std::size_t>(index);
        const Node& node = scene.nodes[at];
        const glm::dmat4 worldFromParent =
            node.parent < 0 ? glm::dmat4(1)
                            : pose.worldFromNode[static_cast<std::size_t>(node.parent)];
        pose.worldFromNode[at] = worldFromParent * parentFromNode(node, locals[at]);
    }
    return pose;
}

}  // namespace penumbra::scene
