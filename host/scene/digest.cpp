// SPDX-License-Identifier: MIT
#include "host/scene/digest.h"

#include <type_traits>

#include "runtime/digest.h"

namespace penumbra::scene {
namespace {

/// Collects a digest per array; the digest of these is the scene's.
class Collector {
  public:
    template <typename T>
    void add(const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        text_ += runtime::digest(values.data(), values.size() * sizeof(T));
    }
    template <typename T>
    void add(const T& value) requires std::is_arithmetic_v<T> || std::is_enum_v<T> {
        text_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    template <int N, typename T>
    void add(const glm::vec<N, T>& v) {
        for (int i = 0; i < N; ++i) add(v[i]);
    }
    template <typename T>
    void add(const glm::mat<4, 4, T>& m) {
        for (int i = 0; i < 4; ++i) add(m[i]);
    }
    void add(const std::string& text) { text_ += text + '\0'; }
    std::string result() const { return runtime::digest(text_); }

  private:
    std::string text_;
};

void add(Collector& c, const TextureRef& t) {
    c.add(t.image), c.add(t.uvSet), c.add(t.wrapU), c.add(t.wrapV), c.add(t.nearest);
    for (int i = 0; i < 3; ++i) c.add(t.uvFromUv[i]);
}

void add(Collector& c, const Material& m) {
    c.add(m.baseColor), c.add(m.metallic), c.add(m.roughness), c.add(m.emissive),
        c.add(m.normalScale);
    for (const auto* t :
         {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.emissiveTexture})
        add(c, *t);
    c.add(m.alphaMode), c.add(m.alphaCutoff), c.add(m.doubleSided), c.add(m.unlit),
        c.add(m.transmission);
}

void add(Collector& c, const Primitive& p) {
    c.add(p.positions), c.add(p.normals), c.add(p.tangents), c.add(p.uvs[0]), c.add(p.uvs[1]);
    c.add(p.colors), c.add(p.joints), c.add(p.weights), c.add(p.indices), c.add(p.material);
    for (const auto& t : p.targets) c.add(t.positions), c.add(t.normals), c.add(t.tangents);
}

void add(Collector& c, const Node& n) {
    c.add(n.parent), c.add(n.mesh), c.add(n.skin), c.add(n.usesMatrix), c.add(n.matrix);
    c.add(n.translation), c.add(n.scale), c.add(n.weights), c.add(n.castShadow),
        c.add(n.receiveShadow);
    c.add(n.rotation.x), c.add(n.rotation.y), c.add(n.rotation.z), c.add(n.rotation.w);
}

void add(Collector& c, const Light& l) {
    c.add(l.name), c.add(l.shape), c.add(l.node), c.add(l.worldFromLight), c.add(l.width),
        c.add(l.height);
    c.add(l.radiance), c.add(l.intensity), c.add(l.innerConeRad), c.add(l.outerConeRad);
    c.add(l.directional), c.add(l.angleRad), c.add(l.illuminance), c.add(l.fovRad),
        c.add(l.nearMetres);
}

}  // namespace

std::string sceneDigest(const Scene& scene) {
    Collector c;
    for (const auto& image : scene.images)
        c.add(image.width), c.add(image.height), c.add(image.texels);
    for (const auto& m : scene.materials) add(c, m);
    for (const auto& mesh : scene.meshes) {
        c.add(mesh.weights);
        for (const auto& p : mesh.primitives) add(c, p);
    }
    for (const auto& skin : scene.skins) {
        c.add(skin.joints);
        for (const auto& m : skin.jointFromMesh) c.add(m);
    }
    for (const auto& node : scene.nodes) add(c, node);
    c.add(scene.order);
    for (const auto& animation : scene.animations)
        for (const auto& ch : animation.channels)
            c.add(ch.node), c.add(ch.path), c.add(ch.interpolation), c.add(ch.times),
                c.add(ch.values);
    for (const auto& camera : scene.cameras)
        c.add(camera.name), c.add(camera.node), c.add(camera.orthographic), c.add(camera.yfov),
            c.add(camera.xmag), c.add(camera.ymag), c.add(camera.znear), c.add(camera.zfar);
    for (const auto& light : scene.lights) add(c, light);
    return c.result();
}

}  // namespace penumbra::scene
