// SPDX-License-Identifier: MIT
// Poses vertices: morph targets, then skin or node matrix, into re-based world space.
//   source vertices --morph weights--> --joint or node matrices--> posed vertices
// Source: glTF 2.0, 3.7.2.2 (morph targets) and 3.7.3 (skins).
// Differs: normals go through the cofactors of the blended matrix, which stay right for any scale.
#include "lib/transform.h"
#include "shared/mesh.h"

inline float3 cofactorTransform(const Affine* m, float3 n) {
    const float3 r0 = m->row[0].xyz, r1 = m->row[1].xyz, r2 = m->row[2].xyz;
    const float3 c0 = cross3(r1, r2), c1 = cross3(r2, r0), c2 = cross3(r0, r1);
    const float determinant = dot(r0, c0);
    const float3 turned = (float3)(dot(c0, n), dot(c1, n), dot(c2, n));
    return determinant < 0.0f ? -turned : turned;
}

inline Affine blendJoints(global const Affine* restrict matrices, int first,
                          global const ushort* restrict joints, global const float* restrict weights,
                          int skinVertex) {
    Affine sum;
    for (int r = 0; r < 3; ++r) sum.row[r] = (float4)(0.0f);
    for (int i = 0; i < 8; ++i) {
        const float weight = weights[8 * skinVertex + i];
        if (weight == 0.0f) continue;
        global const Affine* joint = &matrices[first + (int)joints[8 * skinVertex + i]];
        for (int r = 0; r < 3; ++r) sum.row[r] = fma((float4)(weight), joint->row[r], sum.row[r]);
    }
    return sum;
}

inline int finite3(float3 v) {
    return fabs(v.x) < 1e30f && fabs(v.y) < 1e30f && fabs(v.z) < 1e30f;
}

/// One work-item per posed vertex.
/// vertexItem       [vertex]             index into items
/// source*          [source vertex, 3 or 4]
/// joints, weights  [skinned vertex, 8]
/// morphs           [displacement, 9]    position, normal, tangent
/// posed*           see shared/mesh.h; a vertex that is not finite becomes NaN and is counted
kernel void pose(const int vertexCount, global const uint* restrict vertexItem,
                 global const PoseItem* restrict items, global const float* restrict sourcePositions,
                 global const float* restrict sourceNormals, global const float* restrict sourceTangents,
                 global const ushort* restrict joints, global const float* restrict weights,
                 global const float* restrict morphs, global const float* restrict morphWeights,
                 global const Affine* restrict matrices, global float* restrict positions,
                 global float* restrict normals, global float* restrict tangents,
                 global GeometryCounters* counters) {
    const int vertex = get_global_id(0);
    if (vertex >= vertexCount) return;
    const PoseItem item = items[vertexItem[vertex]];
    const int local_ = vertex - item.targetVertex;
    const uint source = (uint)(item.sourceVertex + local_);
    float3 position = load3(sourcePositions, source), normal = load3(sourceNormals, source);
    const float4 tangent4 = vload4(source, sourceTangents);
    float3 tangent = tangent4.xyz;

    // Displace by the morph targets
    for (int t = 0; t < item.morphCount; ++t) {
        const float weight = morphWeights[item.morphWeight + t];
        if (weight == 0.0f) continue;
        const uint row = 3 * (uint)(item.morphVertex + t * item.vertexCount + local_);
        position += weight * load3(morphs, row);
        normal += weight * load3(morphs, row + 1);
        tangent += weight * load3(morphs, row + 2);
    }

    // Move into the world by the node's matrix or the joints'
    Affine m;
    if (item.skinVertex < 0)
        m = matrices[item.matrix];
    else
        m = blendJoints(matrices, item.matrix, joints, weights, item.skinVertex + local_);
    float3 world = (float3)(dotPoint(m.row[0], position.x, position.y, position.z),
                            dotPoint(m.row[1], position.x, position.y, position.z),
                            dotPoint(m.row[2], position.x, position.y, position.z));
    if (!finite3(world)) {
        world = (float3)(NAN);
        atomic_inc((volatile global uint*)&counters->nonFiniteVertices);
    }
    const float3 worldNormal = normalizeOr(cofactorTransform(&m, normal), (float3)(0.0f, 1.0f, 0.0f));
    const float3 worldTangent =
        normalizeOr((float3)(dotVector(m.row[0], tangent.x, tangent.y, tangent.z),
                             dotVector(m.row[1], tangent.x, tangent.y, tangent.z),
                             dotVector(m.row[2], tangent.x, tangent.y, tangent.z)),
                    (float3)(0.0f));
    vstore3(world, vertex, positions);
    vstore3(worldNormal, vertex, normals);
    vstore4((float4)(worldTangent, tangent4.w), vertex, tangents);
}
