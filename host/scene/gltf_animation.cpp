// SPDX-License-Identifier: MIT
// Animations: every channel's keys as floats, with counts, times and values checked.
#include <cmath>

#include "host/scene/gltf_accessor.h"
#include "host/scene/gltf_context.h"

namespace penumbra::scene {

namespace {

Interpolation readInterpolation(const std::string& name, const std::string& user) {
    if (name == "STEP") return Interpolation::step;
    if (name == "LINEAR") return Interpolation::linear;
    require(name == "CUBICSPLINE",
            "{} has interpolation \"{}\"; allowed are STEP, LINEAR, CUBICSPLINE", user, name);
    return Interpolation::cubicSpline;
}

/// False, with a warning, for channels that move nothing we know.
bool readTarget(LoadContext& context, const tinygltf::AnimationChannel& source, Channel& channel,
                const std::string& user) {
    const std::string& path = source.target_path;
    if (source.target_node < 0) {
        context.warn("animation channels without a node are ignored");
        return false;
    }
    checkIndex(source.target_node, context.scene.nodes.size(), user, "node");
    channel.node = source.target_node;
    const Node& node = context.scene.nodes[static_cast<std::size_t>(channel.node)];
    if (path == "weights") {
        channel.path = Path::weights;
        if (node.mesh >= 0 && context.targetsPerMesh[static_cast<std::size_t>(node.mesh)] > 0)
            return true;
        context.warn(
            fmt::format("{} animates morph weights of node {}, which has none; it is "
                        "ignored",
                        user, channel.node));
        return false;
    }
    if (path != "translation" && path != "rotation" && path != "scale") {
        context.warn(fmt::format("animation channels of \"{}\" are ignored", path));
        return false;
    }
    channel.path = path == "translation" ? Path::translation
                   : path == "rotation"  ? Path::rotation
                                         : Path::scale;
    if (node.usesMatrix)
        context.warn(fmt::format("{} animates node {}, which has a matrix; it is ignored", user,
                                 channel.node));
    return !node.usesMatrix;
}

/// Numbers per key and part, and components of one element of the output accessor.
struct ValueShape {
    std::size_t width;
    int components;
};

ValueShape shapeOf(const LoadContext& context, const Channel& channel) {
    if (channel.path == Path::rotation) return {4, 4};
    if (channel.path != Path::weights) return {3, 3};
    const int mesh = context.scene.nodes[static_cast<std::size_t>(channel.node)].mesh;
    return {context.targetsPerMesh[static_cast<std::size_t>(mesh)], 1};
}

void checkKeys(const Channel& channel, std::size_t width, const std::string& user) {
    for (std::size_t key = 0; key < channel.times.size(); ++key) {
        const float time = channel.times[key];
        require(std::isfinite(time), "{} has a time that is not finite at key {}", user, key);
        require(key == 0 || time > channel.times[key - 1],
                "{} has key {} at {} s, after a key at {} s; times must ascend", user, key, time,
                key == 0 ? 0.0F : channel.times[key - 1]);
    }
    const std::size_t parts = channel.interpolation == Interpolation::cubicSpline ? 3 : 1;
    require(channel.values.size() == channel.times.size() * parts * width,
            "{} has {} numbers for {} keys of {}", user, channel.values.size(),
            channel.times.size(), parts * width);
    for (const float value : channel.values)
        require(std::isfinite(value), "{} has a value that is not finite", user);
}

/// Identity in place of rotations of length 0; tangents of a spline may be 0.
void repairRotations(LoadContext& context, Channel& channel, const std::string& user) {
    const bool cubic = channel.interpolation == Interpolation::cubicSpline;
    for (std::size_t at = cubic ? 4 : 0; at + 4 <= channel.values.size(); at += cubic ? 12 : 4) {
        float* const xyzw = &channel.values[at];
        if (xyzw[0] != 0 || xyzw[1] != 0 || xyzw[2] != 0 || xyzw[3] != 0) continue;
        xyzw[3] = 1;
        context.warn(fmt::format("{} has a rotation of length 0; identity is used", user));
    }
}

void loadChannel(LoadContext& context, const tinygltf::Animation& source, std::size_t index,
                 Animation& animation, const std::string& clip) {
    const tinygltf::AnimationChannel& from = source.channels[index];
    const std::string user = fmt::format("{} channel {}", clip, index);
    checkIndex(from.sampler, source.samplers.size(), user, "sampler");
    Channel channel;
    if (!readTarget(context, from, channel, user)) return;
    const tinygltf::AnimationSampler& sampler =
        source.samplers[static_cast<std::size_t>(from.sampler)];
    const ValueShape shape = shapeOf(context, channel);
    channel.interpolation = readInterpolation(sampler.interpolation, user);
    channel.times = readFloats(context, sampler.input, 1, user + " input");
    channel.values = readFloats(context, sampler.output, shape.components, user + " output");
    checkKeys(channel, shape.width, user);
    if (channel.path == Path::rotation) repairRotations(context, channel, user);
    animation.channels.push_back(std::move(channel));
}

}  // namespace

void loadAnimations(LoadContext& context) {
    for (std::size_t i = 0; i < context.model.animations.size(); ++i) {
        const tinygltf::Animation& source = context.model.animations[i];
        const std::string clip = describe("animation", i, source.name);
        Animation& animation = context.scene.animations.emplace_back();
        animation.name = source.name;
        for (std::size_t channel = 0; channel < source.channels.size(); ++channel)
            loadChannel(context, source, channel, animation, clip);
    }
}

}  // namespace penumbra::scene
