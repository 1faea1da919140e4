// SPDX-License-Identifier: MIT
// Lights on the nodes of the chosen scene.
//   EXT_lights_area (draft, KhronosGroup/glTF pull request 2525): rect and disk, nits, sizes times
//   the node's largest world scale at rest KHR_lights_punctual: point, spot, directional; extras
//   give them a size, which the extension has not: `radius` in metres and `angle` in degrees, on
//   the node or else on the light
// Extras of both kinds, read in the same way, fix the views of the light: `fov` in degrees and
// `near` in metres What cannot be used is named in a warning.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <optional>

#include "host/scene/camera.h"
#include "host/scene/gltf_context.h"
#include "host/scene/gltf_value.h"

namespace penumbra::scene {

namespace {

constexpr double kSunAngleDegrees = 0.53;
constexpr double kMaxFovDegrees = 140;
constexpr double kDefaultNits = 1000;  // of the EXT_lights_area draft

/// Largest length of an axis of the node in the world.
double largestScale(const glm::dmat4& worldFromNode) {
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis)
        largest = std::max(largest, glm::length(glm::dvec3(worldFromNode[axis])));
    return largest;
}

bool isPositive(double value) {
    return std::isfinite(value) && value > 0;
}

/// color * intensity; nothing where a part is negative or not finite.
std::optional<glm::dvec3> readPower(const glm::dvec3& color, double intensity) {
    const glm::dvec3 power = color * intensity;
    for (int i = 0; i < 3; ++i)
        if (!(color[i] >= 0) || !(intensity >= 0) || !std::isfinite(power[i])) return {};
    return power;
}

/// The extras of the node, else those of the light, else nothing.
std::optional<double> readExtra(const tinygltf::Value& node, const tinygltf::Value& light,
                                const char* key, const std::string& user) {
    for (const tinygltf::Value* extras : {&node, &light})
        if (extras->IsObject() && extras->Has(key)) return readNumber(*extras, key, 0, user);
    return {};
}

/// Field of view and near plane from the extras, where they are set.
void readViews(const tinygltf::Value& nodeExtras, const tinygltf::Value& lightExtras,
               const std::string& user, Light& light, std::string& problem) {
    const auto fov = readExtra(nodeExtras, lightExtras, "fov", user);
    const auto near = readExtra(nodeExtras, lightExtras, "near", user);
    if (fov && !(*fov > 0 && *fov <= kMaxFovDegrees))
        problem =
            fmt::format("an extras.fov of {} degrees; allowed are up to {}", *fov, kMaxFovDegrees);
    else if (near && !isPositive(*near))
        problem = fmt::format("an extras.near of {} m", *near);
    light.fovRad = glm::radians(fov.value_or(0));
    light.nearMetres = near.value_or(0);
}

/// Nothing, and why in `problem`, for a light that cannot be used.
std::optional<Light> makeAreaLight(const tinygltf::Value& source, double worldScale,
                                   const std::string& user, std::string& problem) {
    const bool typed = source.Has("type") && source.Get("type").IsString();
    const std::string type = typed ? source.Get("type").Get<std::string>() : "rect";
    const auto power = readPower(readVector(source, "color", glm::dvec3(1), user),
                                 readNumber(source, "intensity", kDefaultNits, user));
    const double size = readNumber(source, "size", 1, user) * worldScale;
    const double aspect =
        source.Has("rect") ? readNumber(source.Get("rect"), "aspect", 1, user) : 1;
    if (type != "rect" && type != "disk")
        problem = fmt::format("type \"{}\"; supported are rect and disk", type);
    else if (!power)
        problem = "a negative color or intensity";
    else if (!isPositive(size) || !isPositive(aspect))
        problem = fmt::format("size {} (times the node's scale) and aspect {}", size, aspect);
    if (!problem.empty()) return {};
    Light light;
    light.shape = type == "rect" ? LightShape::rectangle : LightShape::disk;
    light.width = type == "rect" ? size * aspect : size;
    light.height = size;
    light.radiance = *power;
    return light;
}

/// A distant disk; its radiance is what gives the illuminance on a surface that faces its centre.
std::optional<Light> makeDirectional(const glm::dvec3& lux, double angleDegrees,
                                     std::string& problem) {
    if (!(angleDegrees >= 0 && angleDegrees < 180)) {
        problem = fmt::format("an extras.angle of {} degrees; allowed are 0 to 180", angleDegrees);
        return {};
    }
    Light light;
    light.shape = LightShape::disk;
    light.directional = true;
    light.angleRad = glm::radians(angleDegrees);
    light.illuminance = lux;
    const double sine = std::sin(light.angleRad / 2);
    light.radiance = sine > 0 ? lux / (glm::pi<double>() * sine * sine) : glm::dvec3(0);
    return light;
}

/// Sphere (point) or disk (spot) of a radius; 0 gives hard shadows by `intensity`.
std::optional<Light> makePunctual(const tinygltf::Light& source, const glm::dvec3& candela,
                                  double radius, std::string& problem) {
    const double inner = source.spot.innerConeAngle, outer = source.spot.outerConeAngle;
    const bool spot = source.type == "spot";
    if (!(radius >= 0) || !std::isfinite(radius))
        problem = fmt::format("an extras.radius of {} m", radius);
    else if (spot && !(inner >= 0 && inner < outer && outer <= glm::half_pi<double>() + 1e-6))
        problem = fmt::format("cones of {} and {} rad; needed are 0 <= inner < outer <= pi/2",
                              inner, outer);
    if (!problem.empty()) return {};
    Light light;
    light.shape = spot ? LightShape::disk : LightShape::sphere;
    light.width = light.height = 2 * radius;
    // A disk or sphere of radiance L sends L pi r^2 along its axis
    light.radiance = radius > 0 ? candela / (glm::pi<double>() * radius * radius) : glm::dvec3(0);
    light.intensity = radius > 0 ? glm::dvec3(0) : candela;
    if (spot) {
        light.innerConeRad = inner;
        light.outerConeRad = outer;
    }
    return light;
}

std::optional<Light> makePunctualLight(const tinygltf::Light& source,
                                       const tinygltf::Value& nodeExtras, const std::string& user,
                                       std::string& problem) {
    const bool colored = source.color.size() == 3;
    const auto power = readPower(
        colored ? glm::dvec3(source.color[0], source.color[1], source.color[2]) : glm::dvec3(1),
        source.intensity);
    const auto radius = readExtra(nodeExtras, source.extras, "radius", user);
    const auto angle = readExtra(nodeExtras, source.extras, "angle", user);
    if (!source.color.empty() && !colored)
        problem = fmt::format("a color of {} numbers", source.color.size());
    else if (!power)
        problem = "a negative color or intensity";
    else if (source.type == "directional")
        return makeDirectional(*power, angle.value_or(kSunAngleDegrees), problem);
    else if (source.type == "point" || source.type == "spot")
        return makePunctual(source, *power, radius.value_or(0), problem);
    else
        problem = fmt::format("type \"{}\"; supported are point, spot, directional", source.type);
    return {};
}

int readLightIndex(const tinygltf::Value& extension, std::size_t count, const std::string& user,
                   const char* kind) {
    require(extension.IsObject() && extension.Has("light") && extension.Get("light").IsInt(),
            "{} has an extension for a {} without a whole number 'light'", user, kind);
    const int index = extension.Get("light").Get<int>();
    checkIndex(index, count, user, kind);
    return index;
}

/// Adds the light to the scene and its node, or warns of its problem.
void addLight(LoadContext& context, int nodeIndex, std::optional<Light> light,
              const std::string& name, const std::string& user, const std::string& problem) {
    if (!problem.empty()) {
        context.warn(fmt::format("{} is not used: it has {}", user, problem));
        return;
    }
    Node& node = context.scene.nodes[static_cast<std::size_t>(nodeIndex)];
    light->node = nodeIndex;
    light->name = name.empty() ? node.name : name;
    if (node.light < 0) node.light = static_cast<int>(context.scene.lights.size());
    context.scene.lights.push_back(std::move(*light));
}

void loadAreaLight(LoadContext& context, int nodeIndex, const tinygltf::Value& extension,
                   double worldScale) {
    const auto* root = findExtension(context.model.extensions, "EXT_lights_area");
    static const tinygltf::Value kNoLights;
    const tinygltf::Value& lights =
        root != nullptr && root->Has("lights") ? root->Get("lights") : kNoLights;
    const int index = readLightIndex(extension, lights.ArrayLen(),
                                     fmt::format("node {}", nodeIndex), "area light");
    const tinygltf::Value& source = lights.Get(index);
    const bool namedLight =
        source.IsObject() && source.Has("name") && source.Get("name").IsString();
    const std::string name = namedLight ? source.Get("name").Get<std::string>() : "";
    const std::string user = describe("area light", static_cast<std::size_t>(index), name) +
                             fmt::format(" on node {}", nodeIndex);
    std::string problem = source.IsObject() ? "" : "no properties";
    std::optional<Light> light;
    if (source.IsObject()) light = makeAreaLight(source, worldScale, user, problem);
    if (light) {
        static const tinygltf::Value kNone;
        readViews(context.model.nodes[static_cast<std::size_t>(nodeIndex)].extras,
                  source.Has("extras") ? source.Get("extras") : kNone, user, *light, problem);
    }
    addLight(context, nodeIndex, std::move(light), name, user, problem);
}

}  // namespace

void loadLights(LoadContext& context, const std::vector<glm::dmat4>& worldFromNode) {
    for (const int nodeIndex : context.scene.order) {
        const auto at = static_cast<std::size_t>(nodeIndex);
        const tinygltf::Node& node = context.model.nodes[at];
        if (const auto* area = findExtension(node.extensions, "EXT_lights_area"))
            loadAreaLight(context, nodeIndex, *area, largestScale(worldFromNode[at]));
        const auto* punctual = findExtension(node.extensions, "KHR_lights_punctual");
        if (punctual == nullptr) continue;
        const int index = readLightIndex(*punctual, context.model.lights.size(),
                                         describe("node", at, node.name), "punctual light");
        const tinygltf::Light& source = context.model.lights[static_cast<std::size_t>(index)];
        const std::string user =
            describe("punctual light", static_cast<std::size_t>(index), source.name) +
            fmt::format(" on node {}", nodeIndex);
        std::string problem;
        std::optional<Light> light = makePunctualLight(source, node.extras, user, problem);
        if (light) readViews(node.extras, source.extras, user, *light, problem);
        const bool aimed = source.type != "point";
        if (problem.empty() && aimed && !hasDirection(glm::dvec3(worldFromNode[at][2])))
            problem = "a node whose scale leaves it no direction";
        addLight(context, nodeIndex, std::move(light), source.name, user, problem);
    }
}

}  // namespace penumbra::scene
