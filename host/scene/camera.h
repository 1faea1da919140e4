// SPDX-License-Identifier: MIT
// The camera of a frame.
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "host/scene/animation.h"
#include "host/scene/bounds.h"
#include "host/scene/scene.h"
#include "kernels/shared/raster.h"

namespace penumbra::scene {

/// False for an axis too short, too long or not finite, which a node's scale can make of it.
bool hasDirection(const glm::dvec3& axis);
/// Unit vector along the axis, or `otherwise` where it has no direction.
glm::dvec3 directionOr(const glm::dvec3& axis, const glm::dvec3& otherwise);

/// What the user asks for. Given eye or target, the camera is placed by hand; else by name; else
/// the file's first, else "auto": azimuth 30, elevation 20, field of view 40 degrees, the bounds'
/// sphere fits with 10 % to spare.
struct CameraChoice {
    std::string name;
    std::optional<glm::dvec3> eye, target;
    std::optional<double> fovDegrees;  ///< vertical
};

/// A camera at one time: looks along its local -Z, +Y up.
struct CameraFrame {
    glm::dmat4 worldFromCamera{1};  ///< orthonormal
    bool orthographic = false;
    double yfovRad = 0.69813170079773183;
    double xmag = 1, ymag = 1;  ///< half extents, orthographic
    double nearMetres = 0.01, farMetres = 0;
};

/// Throws Error (usage) naming the cameras where the choice is none of them.
CameraFrame cameraAt(const Scene& scene, const Pose& pose, const CameraChoice& choice,
                     const Bounds& bounds, double aspect);

/// The rasteriser's rows for a world re-based to `centre`; triangleCount, flags and capacity are
/// left 0.
shared::RasterView rasterView(const CameraFrame& camera, const glm::dvec3& centre, int width,
                              int height);

/// Row of the map from re-based world positions to camera depth in metres.
glm::dvec4 depthRow(const CameraFrame& camera, const glm::dvec3& centre);

/// Frame that looks from `eye` to `target`: local -Z points there, +Y as near to `up` as can be.
glm::dmat4 lookAt(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up);

}  // namespace penumbra::scene
