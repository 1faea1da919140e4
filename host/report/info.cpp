// SPDX-License-Identifier: MIT
// What is in a scene file, and what of it penumbra uses.
#include <nlohmann/json.hpp>

#include "host/geometry/mesh_arrays.h"
#include "host/pipeline.h"
#include "host/scene/animation.h"
#include "host/scene/bounds.h"
#include "host/scene/light.h"

namespace penumbra {
namespace {

using nlohmann::json;

json vectorJson(const glm::dvec3& v) {
    return json::array({v.x, v.y, v.z});
}

json meshesJson(const scene::Scene& scene) {
    std::vector<int> uses(scene.meshes.size());
    for (const int node : scene.order) {
        const int mesh = scene.nodes[static_cast<std::size_t>(node)].mesh;
        if (mesh >= 0) ++uses[static_cast<std::size_t>(mesh)];
    }
    json list = json::array();
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        std::size_t triangles = 0, vertices = 0, targets = 0;
        bool skinned = false;
        for (const auto& p : scene.meshes[i].primitives) {
            triangles += p.indices.size() / 3;
            vertices += p.positions.size();
            targets = std::max(targets, p.targets.size());
            skinned |= !p.joints.empty();
        }
        list.push_back({{"name", scene.meshes[i].name},
                        {"primitives", scene.meshes[i].primitives.size()},
                        {"triangles", triangles},
                        {"vertices", vertices},
                        {"morphTargets", targets},
                        {"skinned", skinned},
                        {"closed", geometry::isEdgeClosed(scene.meshes[i])},
                        {"uses", uses[i]}});
    }
    return list;
}

json materialsJson(const scene::Scene& scene) {
    json list = json::array();
    const char* modes[] = {"OPAQUE", "MASK", "BLEND"};
    for (const auto& m : scene.materials) {
        int textures = 0;
        for (const auto* t : {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture,
                              &m.emissiveTexture})
            textures += t->image >= 0 ? 1 : 0;
        list.push_back({{"name", m.name},
                        {"alphaMode", modes[static_cast<int>(m.alphaMode)]},
                        {"doubleSided", m.doubleSided},
                        {"textures", textures},
                        {"transmission", m.transmission},
                        {"unlit", m.unlit}});
    }
    return list;
}

json lightsJson(const scene::Scene& scene, const scene::Bounds& bounds, const scene::Pose& pose) {
    json list = json::array();
    for (const auto& light : scene::lightsAt(scene, pose, bounds, {}))
        list.push_back({{"name", light.name},
                        {"shape", light.isPoint() ? "point"
                                  : light.disk    ? "disk"
                                                  : "rect"},
                        {"at", vectorJson(light.centre)},
                        {"direction", vectorJson(light.axisZ)},
                        {"size", {light.width, light.height}},
                        {"radiance", vectorJson(light.radiance)},
                        {"fromFile", !scene.lights.empty()}});
    return list;
}

}  // namespace

std::string infoJson(const std::string& path) {
    RenderOptions options;
    options.scene = path;
    const auto scene = loadScene(options);
    const auto clips = scene::chooseAnimations(scene, "");
    const auto bounds = scene::clipBounds(scene, clips);
    json result;
    result["scene"] = path.empty() ? "built-in scene" : path;
    result["nodes"] = scene.order.size();
    result["meshes"] = meshesJson(scene);
    std::size_t drawn = 0;
    for (const auto& mesh : result["meshes"])
        drawn += mesh["triangles"].get<std::size_t>() * mesh["uses"].get<std::size_t>();
    result["trianglesDrawn"] = drawn;
    result["materials"] = materialsJson(scene);
    result["images"] = json::array();
    for (const auto& image : scene.images) result["images"].push_back({image.width, image.height});
    result["skins"] = json::array();
    for (const auto& skin : scene.skins)
        result["skins"].push_back({{"joints", skin.joints.size()}});
    result["animations"] = json::array();
    for (std::size_t i = 0; i < scene.animations.size(); ++i)
        result["animations"].push_back(
            {{"name", scene.animations[i].name},
             {"seconds", scene.animations[i].durationSeconds()},
             {"channels", scene.animations[i].channels.size()},
             {"plays", std::find(clips.begin(), clips.end(), static_cast<int>(i)) != clips.end()}});
    result["cameras"] = json::array();
    for (const auto& camera : scene.cameras)
        result["cameras"].push_back({{"name", camera.name}, {"orthographic", camera.orthographic}});
    result["lights"] = lightsJson(scene, bounds, scene::poseAt(scene, clips, 0));
    result["bounds"] = {{"low", vectorJson(bounds.low)},
                        {"high", vectorJson(bounds.high)},
                        {"centre", vectorJson(bounds.centre())},
                        {"radius", bounds.radius()}};
    result["warnings"] = scene.warnings;
    return result.dump(2);
}

}  // namespace penumbra
