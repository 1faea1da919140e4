// SPDX-License-Identifier: MIT
// Materials and their textures as the device reads them.
#pragma once
#include <cstdint>
#include <vector>

#include "host/scene/scene.h"
#include "kernels/shared/mesh.h"

namespace penumbra::geometry {

struct MaterialArrays {
    std::vector<shared::Material> materials;
    std::vector<std::uint32_t> texels;  ///< sRGB decoding table, then images with all MIP levels
};

/// MIP levels are box-filtered in linear light (sRGB images are decoded and encoded again).
MaterialArrays packMaterials(const scene::Scene& scene);

}  // namespace penumbra::geometry
