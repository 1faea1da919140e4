// SPDX-License-Identifier: MIT
// Depth maps of a light's views drawn with OpenGL: a rival of map_raster.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bench/support/egl_context.h"
#include "host/geometry/geometry.h"
#include "host/visibility/light_view.h"

namespace penumbra::bench {

/// per view: a framebuffer and a draw for each; layered: the vertex shader chooses the map of each
/// instance, so that all maps held are one framebuffer and one draw.
enum class EglForm { perView, layered };

using EglMatrix = std::array<float, 16>;  ///< column-major

/// Draws casters with the faces that cull=auto keeps; the mesh must be opaque. Positions and
/// indices are uploaded once; there is no colour buffer and no fragment shader. `held` maps exist
/// at a time: view i is drawn into map i % held.
class EglMaps {
  public:
    EglMaps(const EglContext& context, const geometry::Mesh& mesh,
            const visibility::LightView& view, int held, EglForm form);
    ~EglMaps();
    EglMaps(const EglMaps&) = delete;
    EglMaps& operator=(const EglMaps&) = delete;

    /// Draws all views and waits.
    void run();
    /// Depth map [row, column], reversed: near / z, 0 where nothing was drawn.
    std::vector<float> download(int map) const;

  private:
    void uploadMesh(const geometry::Mesh& mesh);
    void makeMaps();
    void makeProgram();
    void draw(int instances) const;

    EglForm form_;
    int views_, held_, resolution_;
    std::int32_t closedIndices_ = 0, openIndices_ = 0;  ///< closed ones first
    std::uint32_t vertexArray_ = 0, buffers_[2] = {};   ///< positions, indices
    std::uint32_t texture_ = 0, program_ = 0;
    std::vector<EglMatrix> matrices_;
    std::vector<std::uint32_t> framebuffers_;
};

}  // namespace penumbra::bench
