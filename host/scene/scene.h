// SPDX-License-Identifier: MIT
// The scene as the rest of penumbra sees it. The glTF loader fills it; nothing after it knows glTF.
// Everything in here is checked: indices are in range, nodes form a forest, sizes agree.
// Units: metres, seconds, radians; right-handed, +Y up. Matrices are `targetFromSource`,
// column-major.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::scene {

/// 8-bit RGBA image, rows from the top. `texels` has width * height * 4 bytes.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> texels;
};

enum class Wrap { repeat, clamp, mirror };

/// A use of an image by a material. image < 0: absent.
struct TextureRef {
    int image = -1;
    int uvSet = 0;  ///< 0 or 1
    Wrap wrapU = Wrap::repeat, wrapV = Wrap::repeat;
    bool nearest = false;  ///< magnification filter; else bilinear
    glm::mat3x2 uvFromUv =
        glm::mat3x2(1, 0, 0, 1, 0, 0);  ///< KHR_texture_transform: [2x2 | offset]
};

enum class AlphaMode { opaque, mask, blend };

struct Material {
    std::string name;
    glm::vec4 baseColor{1};  ///< linear
    float metallic = 1, roughness = 1;
    glm::vec3 emissive{0};  ///< linear, emissive strength included
    float normalScale = 1;
    TextureRef baseColorTexture;          ///< sRGB
    TextureRef metallicRoughnessTexture;  ///< G roughness, B metallic
    TextureRef normalTexture;             ///< tangent space
    TextureRef emissiveTexture;           ///< sRGB
    AlphaMode alphaMode = AlphaMode::opaque;
    float alphaCutoff = 0.5F;
    bool doubleSided = false;
    bool unlit = false;
    float transmission = 0;  ///< KHR_materials_transmission factor
};

/// Displacements of one morph target; empty vectors where the target leaves an attribute alone.
struct MorphTarget {
    std::vector<glm::vec3> positions, normals, tangents;
};

/// Triangles of one material. All vertex vectors have the length of `positions` or are empty.
/// normals are never empty: the loader makes flat ones where the file has none (it then unshares
/// vertices).
struct Primitive {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec4> tangents;            ///< xyz, w = handedness; empty if absent
    std::array<std::vector<glm::vec2>, 2> uvs;  ///< empty if absent
    std::vector<glm::vec4> colors;              ///< COLOR_0, linear; empty if absent
    std::vector<std::array<std::uint16_t, 8>>
        joints;  ///< indices into the skin's joints; empty if not skinned
    std::vector<std::array<float, 8>> weights;  ///< normalised to sum 1; same length as joints
    std::vector<std::uint32_t> indices;         ///< 3 per triangle, each < positions.size()
    std::vector<MorphTarget> targets;
    int material =
        0;  ///< index into Scene::materials (the loader adds a default material where needed)
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
    std::vector<float> weights;  ///< default weight per morph target
};

struct Skin {
    std::vector<int> joints;                ///< nodes
    std::vector<glm::dmat4> jointFromMesh;  ///< inverse bind matrices, one per joint
};

struct Node {
    std::string name;
    int parent = -1;  ///< -1: root
    int mesh = -1, skin = -1, camera = -1, light = -1;
    bool usesMatrix =
        false;  ///< `matrix` holds the local transform; else translation, rotation, scale
    glm::dmat4 matrix{1};
    glm::dvec3 translation{0}, scale{1};
    glm::dquat rotation{1, 0, 0, 0};               ///< w, x, y, z
    std::vector<float> weights;                    ///< overrides Mesh::weights; empty if absent
    bool castShadow = true, receiveShadow = true;  ///< node extras
};

enum class Path { translation, rotation, scale, weights };
enum class Interpolation { step, linear, cubicSpline };

/// One animated property of one node. `values` holds per key: 3, 4 (x y z w) or weight-count
/// floats, times 3 for cubicSpline (in-tangent, value, out-tangent), as glTF stores them.
struct Channel {
    int node = 0;
    Path path = Path::translation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<float> times;  ///< seconds, strictly ascending, at least one
    std::vector<float> values;
};

struct Animation {
    std::string name;
    std::vector<Channel> channels;
    double durationSeconds() const;  ///< largest key time
};

struct Camera {
    std::string name;
    int node = -1;
    bool orthographic = false;
    double yfov = 0.69813170079773183;  ///< radians, perspective
    double aspect = 0;                  ///< 0: that of the image
    double xmag = 1, ymag = 1;          ///< half extents in metres, orthographic
    double znear = 0.01, zfar = 0;      ///< zfar 0: infinite
};

enum class LightShape { rectangle, disk, sphere };

/// An area light at rest in its node's frame (emits along local -Z), or in the world where node <
/// 0.
struct Light {
    std::string name;
    LightShape shape = LightShape::rectangle;
    int node = -1;
    glm::dmat4 worldFromLight{1};  ///< used where node < 0; orthonormal, no scale
    double width = 1, height = 1;  ///< metres; disk and sphere: both the diameter. 0: hard shadows
    glm::dvec3 radiance{1};        ///< W sr^-1 m^-2, RGB
    glm::dvec3 intensity{0};       ///< for size 0 (a point): candela, RGB; else unused
    double innerConeRad = 0, outerConeRad = 0;  ///< spot; outer 0: no cone
    bool directional = false;                   ///< a distant disk; see angleRad
    double angleRad = 0;                        ///< directional: angular diameter
    glm::dvec3 illuminance{0};                  ///< directional: lux, RGB
    double fovRad = 0, nearMetres = 0;          ///< set by the user; 0: fitted
};

struct Scene {
    std::string name;
    std::vector<Image> images;
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Skin> skins;
    std::vector<Node> nodes;  ///< all nodes of the file
    std::vector<int> order;   ///< nodes of the chosen scene, parents before children
    std::vector<Animation> animations;
    std::vector<Camera> cameras;        ///< only those on a node of the chosen scene
    std::vector<Light> lights;          ///< likewise
    std::vector<std::string> warnings;  ///< what was ignored or replaced, each named once
};

}  // namespace penumbra::scene
