// SPDX-License-Identifier: MIT
// Cameras on the nodes of the chosen scene; a camera that two nodes use becomes two.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "host/scene/camera.h"
#include "host/scene/gltf_context.h"

namespace penumbra::scene {

namespace {

Camera loadCamera(const tinygltf::Camera& source, const std::string& user) {
    Camera camera;
    camera.name = source.name;
    camera.orthographic = source.type == "orthographic";
    if (camera.orthographic) {
        const tinygltf::OrthographicCamera& lens = source.orthographic;
        camera.xmag = std::abs(lens.xmag);
        camera.ymag = std::abs(lens.ymag);
        camera.znear = lens.znear;
        camera.zfar = lens.zfar;
        require(
            camera.xmag > 0 && camera.ymag > 0 && camera.znear >= 0 && lens.zfar > lens.znear,
            "{} has xmag {}, ymag {}, znear {}, zfar {}; needed are xmag, ymag other than 0 and "
            "0 <= znear < zfar",
            user, lens.xmag, lens.ymag, lens.znear, lens.zfar);
        return camera;
    }
    const tinygltf::PerspectiveCamera& lens = source.perspective;
    camera.yfov = lens.yfov;
    camera.aspect = lens.aspectRatio;
    camera.znear = lens.znear;
    camera.zfar = lens.zfar;
    require(lens.yfov > 0 && lens.yfov < glm::pi<double>() && lens.aspectRatio >= 0 &&
                lens.znear > 0 && (lens.zfar == 0 || lens.zfar > lens.znear),
            "{} has yfov {}, aspectRatio {}, znear {}, zfar {}; needed are 0 < yfov < pi, "
            "aspectRatio >= 0 and 0 < znear < zfar",
            user, lens.yfov, lens.aspectRatio, lens.znear, lens.zfar);
    return camera;
}

/// False where the node's scale leaves no direction to look along or no side.
bool hasFrame(const glm::dmat4& worldFromNode) {
    const glm::dvec3 up(worldFromNode[1]), back(worldFromNode[2]);
    return hasDirection(back) && hasDirection(glm::cross(up, back));
}

}  // namespace

void loadCameras(LoadContext& context, const std::vector<glm::dmat4>& worldFromNode) {
    Scene& scene = context.scene;
    for (const int index : scene.order) {
        const int used = context.model.nodes[static_cast<std::size_t>(index)].camera;
        if (used < 0) continue;
        const auto at = static_cast<std::size_t>(used);
        const tinygltf::Camera& source = context.model.cameras[at];
        Node& node = scene.nodes[static_cast<std::size_t>(index)];
        const std::string user = describe("camera", at, source.name);
        Camera camera = loadCamera(source, user);
        if (!hasFrame(worldFromNode[static_cast<std::size_t>(index)])) {
            context.warn(fmt::format("{} is not used: {} scales it to nothing", user,
                                     describe("node", static_cast<std::size_t>(index), node.name)));
            continue;
        }
        camera.node = index;
        if (camera.name.empty()) camera.name = node.name;
        node.camera = static_cast<int>(scene.cameras.size());
        scene.cameras.push_back(std::move(camera));
    }
}

}  // namespace penumbra::scene
