// SPDX-License-Identifier: MIT
// Shading: reflectance x visibility of one light after the other.
//   G-buffer, visibility --closed-form irradiance, GGX over 16 light points--> colour
// Source: Lambert 1760 (irradiance of a polygon); Walter et al. 2007 (GGX) as in glTF 2.0 appendix B.
// Differs: a reflection integrates 16 fixed points of the light, so roughness is at least SHADE_MIN_ROUGHNESS;
// the diffuse part keeps what the Fresnel term reflects (glTF weighs it by 1 - F).
#include "lib/area_light.h"
#include "lib/transform.h"
#include "shared/gbuffer.h"
#include "shared/mesh.h"

#define SHADE_MIN_ROUGHNESS 0.2f

typedef struct {
    V3 position, normal;
    VF roughness;
} ShadeSurface;

inline V3 loadV3(global const float* restrict planes, int stride, int plane, int pixel) {
    V3 r;
    r.x = V_LOAD(planes, plane * stride + pixel);
    r.y = V_LOAD(planes, (plane + 1) * stride + pixel);
    r.z = V_LOAD(planes, (plane + 2) * stride + pixel);
    return r;
}

inline V3 affinePoint(const Affine* m, V3 p) {
    V3 r;
    r.x = fma((VF)m->row[0].x, p.x, fma((VF)m->row[0].y, p.y, fma((VF)m->row[0].z, p.z, (VF)m->row[0].w)));
    r.y = fma((VF)m->row[1].x, p.x, fma((VF)m->row[1].y, p.y, fma((VF)m->row[1].z, p.z, (VF)m->row[1].w)));
    r.z = fma((VF)m->row[2].x, p.x, fma((VF)m->row[2].y, p.y, fma((VF)m->row[2].z, p.z, (VF)m->row[2].w)));
    return r;
}

inline V3 affineVector(const Affine* m, V3 v) {
    V3 r;
    r.x = fma((VF)m->row[0].x, v.x, fma((VF)m->row[0].y, v.y, (VF)m->row[0].z * v.z));
    r.y = fma((VF)m->row[1].x, v.x, fma((VF)m->row[1].y, v.y, (VF)m->row[1].z * v.z));
    r.z = fma((VF)m->row[2].x, v.x, fma((VF)m->row[2].y, v.y, (VF)m->row[2].z * v.z));
    return r;
}

/// Emission and ambient light. One work-item per LANES pixels of the padded image.
/// colour [3, stride]
kernel void shade_begin(const ShadeParams params, global const float* restrict planes,
                        global float* restrict colour) {
    const int pixel = (int)get_global_id(0) * LANES, stride = params.planeStride;
    if (pixel >= stride) return;
    const V3 albedo = loadV3(planes, stride, GB_ALBEDO, pixel);
    const V3 emissive = loadV3(planes, stride, GB_EMISSIVE, pixel);
    V_STORE(fma(albedo.x, (VF)params.ambient.x, emissive.x), colour, pixel);
    V_STORE(fma(albedo.y, (VF)params.ambient.y, emissive.y), colour, stride + pixel);
    V_STORE(fma(albedo.z, (VF)params.ambient.z, emissive.z), colour, 2 * stride + pixel);
}

/// Specular reflection per unit radiance, split for Schlick's Fresnel term: x is multiplied by F0, y added.
inline void reflection(const ShadeLight* light, ShadeSurface s, V3 view, VF* f0Part, VF* f90Part) {
    const VF alpha = s.roughness * s.roughness, alpha2 = alpha * alpha;
    const VF nv = max(v3Dot(s.normal, view), (VF)1e-4f);
    VF sum0 = (VF)0.0f, sum90 = (VF)0.0f;
    for (int i = 0; i < SHADE_POINTS; ++i) {
        const float4 pair = light->point[i >> 1];
        V3 l;
        l.x = (i & 1 ? pair.z : pair.x) - s.position.x;
        l.y = (i & 1 ? pair.w : pair.y) - s.position.y;
        l.z = -s.position.z;
        const VF squared = max(v3Dot(l, l), (VF)1e-12f);
        l = v3Scale(l, 1.0f / sqrt(squared));
        const V3 h = v3Unit(v3Add(l, view));
        const VF nl = max(v3Dot(s.normal, l), (VF)0.0f), nh = max(v3Dot(s.normal, h), (VF)0.0f);
        const VF vh = max(v3Dot(view, h), (VF)0.0f);
        const VF d = fma(nh * nh, alpha2 - 1.0f, (VF)1.0f);
        const VF smith = nl * sqrt(fma(nv * nv, 1.0f - alpha2, alpha2)) +
                         nv * sqrt(fma(nl * nl, 1.0f - alpha2, alpha2));
        const VF lobe = alpha2 * 0.31830989f / (d * d) * 0.5f / max(smith, (VF)1e-6f);
        // Solid angle of the point's share of the light, one-sided
        const VF share = light->corners > 0 ? max(-l.z, (VF)0.0f) * light->area / squared : 1.0f / squared;
        const VF weight = lobe * nl * share * (1.0f / SHADE_POINTS);
        const VF c = 1.0f - vh, fresnel = c * c * c * c * c;
        sum0 += weight * (1.0f - fresnel);
        sum90 += weight * fresnel;
    }
    *f0Part = sum0;
    *f90Part = sum90;
}

inline VF coneFalloff(const ShadeLight* light, V3 p) {
    const VF cosine = p.z / sqrt(max(v3Dot(p, p), (VF)1e-30f));
    const float range = max(light->cosInner - light->cosOuter, 1e-4f);
    const VF t = clamp((cosine - light->cosOuter) / range, (VF)0.0f, (VF)1.0f);
    return light->cosOuter < -1.5f ? (VF)1.0f : t * t;
}

/// Adds one light. visibility [channels, stride]. One work-item per LANES pixels.
kernel void shade_light(const ShadeParams params, const ShadeLight light,
                        global const float* restrict planes, global const float* restrict visibility,
                        global float* restrict colour) {
    const int pixel = (int)get_global_id(0) * LANES, stride = params.planeStride;
    if (pixel >= stride) return;
    const int channelStride = params.channels == 3 ? stride : 0;
    const VF seen[3] = {V_LOAD(visibility, pixel), V_LOAD(visibility, channelStride + pixel),
                        V_LOAD(visibility, 2 * channelStride + pixel)};
    VI lit = V_MASK(V_AS_INT(V_LOAD(planes, GB_OBJECT * stride + pixel)) != 0) &
             V_MASK(max(seen[0], max(seen[1], seen[2])) > 0.0f);
    if (!V_ANY(lit)) return;
    const V3 world = loadV3(planes, stride, GB_POSITION, pixel);
    const V3 albedo = loadV3(planes, stride, GB_ALBEDO, pixel);
    const VF metallic = V_LOAD(planes, GB_METALLIC * stride + pixel);
    ShadeSurface s;
    s.position = affinePoint(&light.lightFromWorld, world);
    s.normal = affineVector(&light.lightFromWorld, loadV3(planes, stride, GB_NORMAL, pixel));
    s.roughness = max(V_LOAD(planes, GB_ROUGHNESS * stride + pixel), (VF)SHADE_MIN_ROUGHNESS);

    // What faces away from the whole light is dark, however its normals are smoothed
    const V3 geometric = affineVector(&light.lightFromWorld, loadV3(planes, stride, GB_GEOMETRIC, pixel));
    const VF facing = fabs(geometric.x) * light.halfWidth + fabs(geometric.y) * light.halfHeight -
                      v3Dot(geometric, s.position);
    lit &= V_MASK(facing > 0.0f);
    if (!V_ANY(lit)) return;
    VF irradiance;
    if (light.corners > 0) {
        irradiance = polygonIrradiance(&light, s.position, s.normal);
    } else {
        const VF squared = max(v3Dot(s.position, s.position), (VF)1e-12f);
        irradiance = max(-v3Dot(s.position, s.normal), (VF)0.0f) / (squared * sqrt(squared));
    }
    V3 towardsEye;
    towardsEye.x = params.eye.x - world.x * params.eye.w;
    towardsEye.y = params.eye.y - world.y * params.eye.w;
    towardsEye.z = params.eye.z - world.z * params.eye.w;
    const V3 view = v3Unit(affineVector(&light.lightFromWorld, towardsEye));
    VF f0Part, f90Part;
    reflection(&light, s, view, &f0Part, &f90Part);

    const VF cone = coneFalloff(&light, s.position);
    const VF diffuse = irradiance * 0.31830989f * (1.0f - metallic) * cone;
    const VF strength = V_SELECT((VF)0.0f, (VF)1.0f, lit);
    // Unlit surfaces reflect nothing; black ones do
    const VI unlit = V_AS_INT(V_LOAD(planes, GB_FLAGS * stride + pixel)) & (VI)DRAW_UNLIT;
    const VF white = V_SELECT(cone, (VF)0.0f, V_MASK(unlit != 0));
    const VF albedos[3] = {albedo.x, albedo.y, albedo.z};
    const float radiances[3] = {light.radiance.x, light.radiance.y, light.radiance.z};
    for (int channel = 0; channel < 3; ++channel) {
        const VF f0 = fma(albedos[channel] - 0.04f, metallic, (VF)0.04f);
        const VF reflected = fma(albedos[channel], diffuse, fma(f0, f0Part, f90Part) * white);
        const VF old = V_LOAD(colour, channel * stride + pixel);
        V_STORE(fma(reflected * radiances[channel] * strength, seen[channel], old), colour, channel * stride + pixel);
    }
}
