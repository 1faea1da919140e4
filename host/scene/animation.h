// SPDX-License-Identifier: MIT
// Poses a scene at a time: node matrices, joint matrices' inputs and morph weights.
#pragma once
#include <string>
#include <vector>

#include "host/scene/scene.h"

namespace penumbra::scene {

/// The clips that play. `all` plays clip 0 and each later clip that moves other nodes (no node is
/// moved by two clips); a name or an index plays that clip; "none" is the pose of rest.
/// Throws Error (usage) naming the clips where `choice` is none of them. An empty choice means
/// default.
std::vector<int> chooseAnimations(const Scene& scene, const std::string& choice);

/// Longest of the chosen clips; 0 without any.
double clipDurationSeconds(const Scene& scene, const std::vector<int>& clips);

/// State of all nodes at one time.
struct Pose {
    std::vector<glm::dmat4>
        worldFromNode;  ///< [node]; nodes outside of the chosen scene keep identity
    std::vector<std::vector<float>>
        weights;  ///< [node] morph weights; empty where the node's mesh has no targets
};

/// Evaluates the chosen clips at `seconds`; time is clamped to each channel's keys.
/// STEP, LINEAR (rotations by slerp, the shorter way) and CUBICSPLINE (rotations normalised), as
/// glTF 2.0.
Pose poseAt(const Scene& scene, const std::vector<int>& clips, double seconds);

}  // namespace penumbra::scene
