// SPDX-License-Identifier: MIT
#include "host/scene/camera.h"

#include <algorithm>
#include <cmath>

#include "runtime/error.h"

namespace penumbra::scene {
namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kAutoFov = 40 * kDegree, kAzimuth = 30 * kDegree, kElevation = 20 * kDegree;
constexpr double kSpare = 1.1;

/// The orthonormal frame nearest to a node's matrix, whatever its scale.
glm::dmat4 withoutScale(const glm::dmat4& m) {
    const glm::dvec3 z = directionOr(glm::dvec3(m[2]), {0, 0, 1});
    const glm::dvec3 across = directionOr(glm::cross({z.y, z.z, z.x}, z), {1, 0, 0});
    const glm::dvec3 x = directionOr(glm::cross(glm::dvec3(m[1]), z), across);
    return {glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), m[3]};
}

CameraFrame placedCamera(const CameraChoice& choice, const Bounds& bounds, double aspect) {
    CameraFrame camera;
    camera.yfovRad = choice.fovDegrees ? *choice.fovDegrees * kDegree : kAutoFov;
    const double radius = bounds.empty ? 1 : std::max(bounds.radius(), 1e-9);
    const glm::dvec3 target = choice.target.value_or(bounds.centre());
    const double halfFov =
        std::min(camera.yfovRad / 2, std::atan(std::tan(camera.yfovRad / 2) * aspect));
    const double distance = kSpare * radius / std::sin(halfFov);
    const glm::dvec3 direction(std::sin(kAzimuth) * std::cos(kElevation), std::sin(kElevation),
                               std::cos(kAzimuth) * std::cos(kElevation));
    const glm::dvec3 eye = choice.eye.value_or(target + distance * direction);
    requireUsage(glm::length(eye - target) > 0, "--eye and --target are the same point; move one");
    camera.worldFromCamera = lookAt(eye, target, {0, 1, 0});
    camera.nearMetres = 1e-3 * glm::length(eye - target);
    return camera;
}

CameraFrame fileCamera(const Camera& camera, const Pose& pose, const CameraChoice& choice,
                       const Bounds& bounds) {
    CameraFrame frame;
    frame.worldFromCamera = withoutScale(pose.worldFromNode[static_cast<std::size_t>(camera.node)]);
    frame.orthographic = camera.orthographic;
    frame.yfovRad = choice.fovDegrees ? *choice.fovDegrees * kDegree : camera.yfov;
    frame.xmag = camera.xmag;
    frame.ymag = camera.ymag;
    frame.nearMetres = camera.znear;
    frame.farMetres = camera.zfar;
    if (frame.orthographic && !bounds.empty) {
        // Nothing is cut at zfar: depth must not fall below 0 before the scene and its ground end
        const glm::dvec3 eye(frame.worldFromCamera[3]), backwards(frame.worldFromCamera[2]);
        const double middle = glm::dot(eye - bounds.centre(), backwards);
        frame.farMetres =
            std::max(frame.farMetres, frame.nearMetres + std::abs(middle) + 8 * bounds.radius());
    }
    return frame;
}

std::string cameraNames(const Scene& scene) {
    std::string names = "auto";
    for (std::size_t i = 0; i < scene.cameras.size(); ++i)
        names += fmt::format(", {} '{}'", i, scene.cameras[i].name);
    return names;
}

const Camera* findCamera(const Scene& scene, const std::string& name) {
    for (std::size_t i = 0; i < scene.cameras.size(); ++i)
        if (scene.cameras[i].name == name || std::to_string(i) == name) return &scene.cameras[i];
    return nullptr;
}

glm::dvec4 rowOf(const glm::dmat4& m, int row) {
    return {m[0][row], m[1][row], m[2][row], m[3][row]};
}

shared::float4 narrow(const glm::dvec4& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
            static_cast<float>(v.w)};
}

glm::dmat4 cameraFromRebased(const CameraFrame& camera, const glm::dvec3& centre) {
    glm::dmat4 worldFromRebased(1);
    worldFromRebased[3] = glm::dvec4(centre, 1);
    return glm::inverse(camera.worldFromCamera) * worldFromRebased;
}

}  // namespace

bool hasDirection(const glm::dvec3& axis) {
    const double length = glm::length(axis);
    return length > 1e-150 && std::isfinite(length);
}

glm::dvec3 directionOr(const glm::dvec3& axis, const glm::dvec3& otherwise) {
    return hasDirection(axis) ? axis / glm::length(axis) : otherwise;
}

glm::dmat4 lookAt(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up) {
    const glm::dvec3 z = glm::normalize(eye - target);
    glm::dvec3 side = glm::cross(up, z);
    if (glm::length(side) < 1e-6) side = glm::cross(glm::dvec3(0, 0, z.z > 0 ? -1 : 1), z);
    if (glm::length(side) < 1e-6) side = glm::cross(glm::dvec3(1, 0, 0), z);
    const glm::dvec3 x = glm::normalize(side);
    return {glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0),
            glm::dvec4(eye, 1)};
}

CameraFrame cameraAt(const Scene& scene, const Pose& pose, const CameraChoice& choice,
                     const Bounds& bounds, double aspect) {
    if (choice.fovDegrees)
        requireUsage(*choice.fovDegrees > 0 && *choice.fovDegrees < 180,
                     "--fov {} is outside of (0, 180) degrees", *choice.fovDegrees);
    if (choice.eye || choice.target) return placedCamera(choice, bounds, aspect);
    if (!choice.name.empty() && choice.name != "auto") {
        const Camera* camera = findCamera(scene, choice.name);
        requireUsage(camera != nullptr, "--camera '{}' is not in the scene; allowed: {}",
                     choice.name, cameraNames(scene));
        return fileCamera(*camera, pose, choice, bounds);
    }
    if (choice.name.empty() && !scene.cameras.empty())
        return fileCamera(scene.cameras[0], pose, choice, bounds);
    return placedCamera(choice, bounds, aspect);
}

glm::dvec4 depthRow(const CameraFrame& camera, const glm::dvec3& centre) {
    return -rowOf(cameraFromRebased(camera, centre), 2);
}

shared::RasterView rasterView(const CameraFrame& camera, const glm::dvec3& centre, int width,
                              int height) {
    const glm::dmat4 m = cameraFromRebased(camera, centre);
    const glm::dvec4 x = rowOf(m, 0), y = rowOf(m, 1), depth = -rowOf(m, 2), one(0, 0, 0, 1);
    const double halfWidth = 0.5 * width, halfHeight = 0.5 * height;
    shared::RasterView view{};
    view.width = width;
    view.height = height;
    if (camera.orthographic) {
        // Depth falls linearly from 1 at the near plane; far is only a scale, nothing is cut there
        const double range = camera.farMetres > camera.nearMetres
                                 ? camera.farMetres - camera.nearMetres
                                 : 1000 * std::max(camera.xmag, camera.ymag);
        view.rowX = narrow(halfWidth * (one + x / camera.xmag));
        view.rowY = narrow(halfHeight * (one - y / camera.ymag));
        view.rowW = narrow(one);
        view.rowD = narrow(((camera.nearMetres + 2 * range) * one - depth) / (2 * range));
        return view;
    }
    const double fy = 1 / std::tan(camera.yfovRad / 2), fx = fy * height / width;
    view.rowX = narrow(halfWidth * (depth + fx * x));
    view.rowY = narrow(halfHeight * (depth - fy * y));
    view.rowW = narrow(depth);
    view.rowD = narrow(camera.nearMetres * one);
    return view;
}

}  // namespace penumbra::scene
