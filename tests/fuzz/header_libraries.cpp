// SPDX-License-Identifier: MIT
// tinygltf and stb from their headers, so that they are instrumented like our own code.
#define TINYGLTF_IMPLEMENTATION
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <tiny_gltf.h>
