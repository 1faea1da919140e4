// SPDX-License-Identifier: MIT
// The posed mesh on the device, shared by every pass.
//   positions, normals  [vertex, 3]   world space, metres; re-based to the clip's centre
//   tangents            [vertex, 4]   w = handedness, 0: derive from the triangle
//   indices             [triangle, 3]
//   triangleDraw        [triangle]    index into draws
//   uvs                 [source vertex, 4]  set 0, set 1
//   colours             [source vertex]     RGBA8, linear, red lowest
//   texels              [256 | ...]   first the sRGB decoding table as float bits, then RGBA8 images
#ifndef SHARED_MESH_H
#define SHARED_MESH_H
#include "shared/portable.h"
SHARED_BEGIN

// Flags of a draw
#define DRAW_CASTS 1u          // casts shadows
#define DRAW_RECEIVES 2u       // receives shadows
#define DRAW_SINGLE_SIDED 4u   // the camera does not see its back
#define DRAW_CLOSED 8u         // edge-closed: a light need not see its back
#define DRAW_MIRRORED 16u      // negative determinant: winding is reversed
#define DRAW_MASK 32u          // alpha tested
#define DRAW_BLEND 64u         // blended or transmissive
#define DRAW_UNLIT 128u
#define DRAW_COLOURS 256u      // vertex colours are present
#define DRAW_TEXTURED 512u     // the material reads a texture
#define DRAW_ENCLOSES 1024u    // closed, and something lies inside: both faces matter to it
#define DRAW_ANY 0x80000000u   // set in every draw

// Flags of a material
#define MATERIAL_OPAQUE 1u     // alphaMode OPAQUE: alpha is ignored
#define MATERIAL_BLENDS 2u     // no texel is opaque or nothing: all fragments are blended

#define BLEND_OPAQUE_ALPHA 0.9999f  // from here on BLEND is opaque: rounding may leave that much of an interpolated 1

/// One primitive of one node.
typedef struct {
    uint flags;     ///< DRAW_*
    uint material;  ///< index into materials
    uint object;    ///< what id.object shows: node index + 1
    int sourceOffset;  ///< source vertex - posed vertex: uvs and colours are kept once per primitive
} Draw;
SHARED_STRUCT(Draw, 16)

/// How the geometry pass makes the vertices of one draw from those of a primitive.
typedef struct {
    int sourceVertex;   ///< first vertex in the source arrays
    int targetVertex;   ///< first posed vertex
    int vertexCount;
    int matrix;         ///< first matrix: node's, or the skin's joints
    int skinVertex;     ///< first vertex in joints/weights arrays, -1: rigid
    int morphVertex;    ///< first displacement in the morph arrays, -1: none
    int morphCount;     ///< targets; displacements of target t start at morphVertex + t * vertexCount
    int morphWeight;    ///< first weight in the frame's weights
} PoseItem;
SHARED_STRUCT(PoseItem, 32)

/// A use of a texture: level 0 starts at texel `offset`; further levels follow, each halved.
typedef struct {
    int offset;  ///< into texels; -1: absent
    int width, height, levels;
    int uvSet;
    int wrap;  ///< bits 0-1 u, 2-3 v: 0 repeat, 1 clamp, 2 mirror; bit 4: nearest; bit 5: sRGB
    float a, b, c, d, e, f;  ///< u' = a u + b v + c, v' = d u + e v + f
} Texture;
SHARED_STRUCT(Texture, 48)

typedef struct {
    Texture baseColorTexture, metallicRoughnessTexture, normalTexture, emissiveTexture;
    float4 baseColor;   ///< linear RGBA
    float4 emissive;    ///< linear RGB
    float metallic, roughness, normalScale, alphaCutoff;
    float transmission;
    uint flags;  ///< MATERIAL_*
    int unused[2];
} Material;
SHARED_STRUCT(Material, 256)

/// What happened to the geometry of a frame; read by the host after the frame.
typedef struct {
    uint nonFiniteVertices;
    uint unused[3];
} GeometryCounters;
SHARED_STRUCT(GeometryCounters, 16)

SHARED_END
#endif
