// SPDX-License-Identifier: MIT
#include "host/visibility/raytrace.h"

#include <bit>

#include "kernels/shared/gbuffer.h"
#include "runtime/error.h"
#include "runtime/profiler.h"

namespace penumbra::visibility {
namespace {

shared::float4 narrow(const glm::dvec3& v, double w) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
            static_cast<float>(w)};
}

/// Sample positions in the re-based world: [3, sample].
std::vector<float> samplePositions(const scene::AreaLight& light, const glm::dvec3& centre) {
    const std::size_t count = light.samples.size();
    std::vector<float> positions(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 p = light.centre - centre + light.samples[i].x * light.axisX +
                             light.samples[i].y * light.axisY;
        for (int axis = 0; axis < 3; ++axis)
            positions[static_cast<std::size_t>(axis) * count + i] = static_cast<float>(p[axis]);
    }
    return positions;
}

}  // namespace

RayPass::RayPass(const runtime::Program& raytrace, int width, int height)
    : device_(&raytrace.device()), raytrace_(raytrace, "raytrace") {
    image_.width = width;
    image_.height = height;
    image_.planeStride = shared::gbufferStride(width * height);
    image_.pixelStep = 1;
    image_.originOffset = SHADOW_ORIGIN_OFFSET;
}

void RayPass::run(const Inputs& inputs, const Bvh& bvh, U32 onlyState, bool classify,
                  Visibility& visibility) {
    require(inputs.gbuffer.planeStride == image_.planeStride,
            "rays were prepared for G-buffer planes of {} floats, they have {}", image_.planeStride,
            inputs.gbuffer.planeStride);
    device_->profiler().beginStage("rays");
    const auto& light = inputs.light;
    samples_.grow(*device_, "ray targets", 3 * light.samples.size());
    samples_.uploadLater(samplePositions(light, inputs.centre));
    shared::RaytraceParams params{};
    const glm::dvec3 origin = light.centre - inputs.centre;
    const glm::dvec3 axes[] = {light.axisX, light.axisY, light.axisZ};
    for (int i = 0; i < 3; ++i)
        params.lightFromWorld.row[i] = narrow(axes[i], -glm::dot(axes[i], origin));
    params.halfWidth = static_cast<float>(light.width / 2);
    params.halfHeight = static_cast<float>(light.height / 2);
    params.samples = static_cast<int>(light.samples.size());
    params.channels = visibility.channels;
    params.onlyState = onlyState;
    params.classify = classify ? 1 : 0;
    if (light.randomSeed) {
        params.shape = light.disk ? RAY_SAMPLES_DISK : RAY_SAMPLES_RECTANGLE;
        params.centre = narrow(origin, std::bit_cast<float>(*light.randomSeed));
        params.axisX = narrow(light.width / 2 * light.axisX, 0);
        params.axisY = narrow(light.height / 2 * light.axisY, 0);
    }
    params.mean = inputs.mesh.hasBlend && visibility.channels == 1 ? 1 : 0;
    image_.worldMagnitude = static_cast<float>(inputs.casters.empty ? 0 : inputs.casters.radius());
    const auto& mesh = inputs.mesh;
    const std::uint64_t group = device_->info().isCpu ? 16 : 64;
    raytrace_.launch({static_cast<std::uint64_t>(image_.planeStride)}, {group}, params, image_,
                     bvh.params(), inputs.gbuffer.planes, bvh.nodes(), bvh.leaves(),
                     bvh.leafTriangles(), samples_, mesh.indices, mesh.triangleDraw, mesh.draws,
                     mesh.materials, mesh.uvs, mesh.colours, mesh.texels, visibility.state,
                     visibility.planes);
}

Raytrace::Raytrace(const TechniqueContext& context)
    : frame_(context.device, "frame"),
      program_(context.device, "raytrace"),
      bvh_(frame_, program_),
      pass_(program_, context.width, context.height) {
    parseSettings<RaytraceSettings>("raytrace", context.values);
}

void Raytrace::run(const Inputs& inputs, Visibility& visibility) {
    visibility.channels = channels(inputs.mesh);
    pass_.run(inputs, bvh_, STATE_TESTED, true, visibility);
}

}  // namespace penumbra::visibility
