// SPDX-License-Identifier: MIT
#include "host/scene/light.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "host/scene/camera.h"
#include "runtime/error.h"

namespace penumbra::scene {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSunDistance = 20;      // R
constexpr double kLargestNumber = 1e12;  // of --light: products of some stay finite floats

std::string cleanName(const std::string& name, std::size_t index, std::set<std::string>& used) {
    std::string clean;
    for (const char c : name)
        clean += std::isalnum(static_cast<unsigned char>(c)) || c == '-' ? c : '_';
    if (clean.empty()) clean = fmt::format("light{}", index);
    while (!used.insert(clean).second) clean += fmt::format("_{}", index);
    return clean;
}

/// Sets the frame so that the light goes along `direction` and axisX is near to `hint`.
void aim(AreaLight& light, const glm::dvec3& direction, const glm::dvec3& hint) {
    light.axisZ = directionOr(direction, {0, -1, 0});
    const glm::dvec3 side = directionOr(hint, {0, 0, 0});
    glm::dvec3 x = side - glm::dot(side, light.axisZ) * light.axisZ;
    if (glm::length(x) < 1e-9) x = glm::cross(light.axisZ, glm::dvec3(0.31, 0.77, -0.55));
    light.axisX = glm::normalize(x);
    light.axisY = glm::cross(light.axisZ, light.axisX);
}

void makeDirectional(const Light& source, const Bounds& bounds, AreaLight& light) {
    const double radius = bounds.empty ? 1 : std::max(bounds.radius(), 1e-9);
    const double distance = kSunDistance * radius;
    const double tangent = std::tan(source.angleRad / 2);
    light.centre = bounds.centre() - distance * light.axisZ;
    light.disk = true;
    light.width = light.height = 2 * distance * tangent;
    // The disk's radiance is such that its irradiance at C is the light's illuminance
    const double sine2 = tangent * tangent / (1 + tangent * tangent);
    light.radiance = source.angleRad > 0 ? source.illuminance / (kPi * sine2)
                                         : source.illuminance * distance * distance;
}

AreaLight lightAt(const Light& source, const Pose& pose, const Bounds& bounds) {
    AreaLight light;
    const glm::dmat4 world = source.node >= 0
                                 ? pose.worldFromNode[static_cast<std::size_t>(source.node)]
                                 : source.worldFromLight;
    light.centre = glm::dvec3(world[3]);
    light.disk = source.shape != LightShape::rectangle;
    light.width = source.width;
    light.height = source.height;
    light.radiance = source.radiance;
    light.innerConeRad = source.innerConeRad;
    light.outerConeRad = source.outerConeRad;
    light.fovRad = source.fovRad;
    light.nearMetres = source.nearMetres;
    aim(light, -glm::dvec3(world[2]), glm::dvec3(world[0]));
    if (source.directional) {
        makeDirectional(source, bounds, light);
    } else if (source.shape == LightShape::sphere) {
        const glm::dvec3 towards = bounds.centre() - light.centre;
        if (glm::length(towards) > 1e-9) aim(light, towards, glm::dvec3(world[0]));
    }
    if (light.isPoint() && !source.directional) light.radiance = source.intensity;
    return light;
}

Light defaultLight(const Bounds& bounds) {
    const double radius = bounds.empty ? 1 : std::max(bounds.radius(), 1e-9);
    Light light;
    light.width = light.height = 0.75 * radius;
    light.radiance = glm::dvec3(50);
    const glm::dvec3 at = bounds.centre() + 3 * radius * glm::normalize(glm::dvec3(-0.5, 1, 0.6));
    light.worldFromLight = lookAt(at, bounds.centre(), {0, 1, 0});
    return light;
}

// --light "shape:key=value;..."

std::vector<double> numbers(const std::string& field, const std::string& text, char separator) {
    std::vector<double> values;
    std::size_t begin = 0;
    while (begin <= text.size()) {
        const auto end = std::min(text.find(separator, begin), text.size());
        double value = 0;
        const auto [stop, error] = std::from_chars(text.data() + begin, text.data() + end, value);
        requireUsage(
            error == std::errc() && stop == text.data() + end && std::abs(value) <= kLargestNumber,
            "--light: {}={} is not a list of numbers, up to {}, separated by '{}'", field, text,
            kLargestNumber, separator);
        values.push_back(value);
        begin = end + 1;
    }
    return values;
}

glm::dvec3 vectorField(const std::string& field, const std::string& text) {
    const auto v = numbers(field, text, ',');
    requireUsage(v.size() == 3, "--light: {}={} needs three numbers x,y,z", field, text);
    return {v[0], v[1], v[2]};
}

double positiveField(const std::string& field, const std::string& text, bool allowZero) {
    const auto v = numbers(field, text, ',');
    requireUsage(v.size() == 1 && (v[0] > 0 || (allowZero && v[0] == 0)),
                 "--light: {}={} must be {} 0", field, text,
                 allowZero ? "at least" : "greater than");
    return v[0];
}

std::map<std::string, std::string> lightFields(const std::string& text) {
    std::map<std::string, std::string> fields;
    std::size_t begin = 0;
    while (begin < text.size()) {
        const auto end = std::min(text.find(';', begin), text.size());
        const std::string item = text.substr(begin, end - begin);
        const auto equals = item.find('=');
        requireUsage(equals != std::string::npos, "--light: '{}' is not key=value", item);
        requireUsage(fields.emplace(item.substr(0, equals), item.substr(equals + 1)).second,
                     "--light: '{}' is given twice", item.substr(0, equals));
        begin = end + 1;
    }
    return fields;
}

void applySize(Light& light, const std::string& field, const std::string& value) {
    if (light.shape == LightShape::rectangle) {
        requireUsage(field == "size", "--light: rect has size=WxH, not {}", field);
        const auto v = numbers(field, value, 'x');
        requireUsage(v.size() == 2 && v[0] >= 0 && v[1] >= 0,
                     "--light: size={} needs WxH in metres", value);
        light.width = v[0];
        light.height = v[1];
    } else {
        requireUsage(field == "radius", "--light: disk and sphere have radius=, not {}", field);
        light.width = light.height = 2 * positiveField(field, value, true);
    }
}

}  // namespace

std::vector<AreaLight> lightsAt(const Scene& scene, const Pose& pose, const Bounds& bounds,
                                const SampleChoice& samples) {
    std::vector<AreaLight> lights;
    std::set<std::string> used;
    const std::vector<Light> fallback{defaultLight(bounds)};
    const auto& sources = scene.lights.empty() ? fallback : scene.lights;
    for (std::size_t i = 0; i < sources.size(); ++i) {
        AreaLight light = lightAt(sources[i], pose, bounds);
        light.name = cleanName(sources[i].name, i, used);
        placeSamples(samples, light);
        lights.push_back(std::move(light));
    }
    return lights;
}

glm::dvec3 facingIrradiance(const AreaLight& light, const glm::dvec3& point) {
    const glm::dvec3 offset = point - light.centre;
    const double squared = std::max(glm::dot(offset, offset), 1e-12);
    if (light.isPoint()) return light.radiance / squared;
    // A light at the point itself shines on what faces it
    const double distance = glm::length(offset);
    const double cosine =
        distance > 1e-9 ? std::max(glm::dot(offset / distance, light.axisZ), 0.0) : 1.0;
    const double area = light.width * light.height * (light.disk ? kPi / 4 : 1);
    // A disk of the same area seen from its axis: exact there, and finite close by
    return light.radiance * cosine * area / (squared + area / kPi);
}

Light parseLight(const std::string& text) {
    Light light;
    const auto colon = text.find(':');
    const std::string shape = text.substr(0, colon);
    if (shape == "rect")
        light.shape = LightShape::rectangle;
    else if (shape == "disk")
        light.shape = LightShape::disk;
    else if (shape == "sphere")
        light.shape = LightShape::sphere;
    else
        throw Error(
            fmt::format("--light '{}' begins with an unknown shape; allowed: rect:, disk:, sphere:",
                        text),
            ExitCode::usage);
    const auto fields = lightFields(colon == std::string::npos ? "" : text.substr(colon + 1));
    glm::dvec3 at(0, 4, 0), target(0), up(0, 1, 0);
    light.radiance = glm::dvec3(20);
    for (const auto& [key, value] : fields) {
        if (key == "at")
            at = vectorField(key, value);
        else if (key == "aim")
            target = vectorField(key, value);
        else if (key == "up")
            up = vectorField(key, value);
        else if (key == "size" || key == "radius")
            applySize(light, key, value);
        else if (key == "fov")
            light.fovRad = positiveField(key, value, false) * kPi / 180;
        else if (key == "near")
            light.nearMetres = positiveField(key, value, false);
        else if (key == "name")
            light.name = value;
        else if (key == "radiance") {
            const auto v = numbers(key, value, ',');
            requireUsage(v.size() == 1 || v.size() == 3,
                         "--light: radiance={} needs one or three numbers", value);
            requireUsage(std::all_of(v.begin(), v.end(), [](double x) { return x >= 0; }),
                         "--light: radiance={} must be at least 0", value);
            light.radiance = v.size() == 1 ? glm::dvec3(v[0]) : glm::dvec3(v[0], v[1], v[2]);
        } else {
            throw Error(
                fmt::format("--light: '{}' is unknown; allowed: at, aim, up, size (rect), radius "
                            "(disk, sphere), radiance, fov, near, name",
                            key),
                ExitCode::usage);
        }
    }
    requireUsage(light.fovRad < kPi * 140.5 / 180, "--light: fov is greater than 140 degrees");
    requireUsage(glm::length(at - target) > 0, "--light: at and aim are the same point");
    light.intensity = light.radiance;
    light.worldFromLight = lookAt(at, target, up);
    return light;
}

}  // namespace penumbra::scene
