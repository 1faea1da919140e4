// SPDX-License-Identifier: MIT
#include "bench/support/egl_maps.h"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>
#include <fmt/format.h>

#include <algorithm>

#include "runtime/error.h"

namespace penumbra::bench {
namespace {

/// Clip space <- world, so that window coordinates are texels of shared/multi_view.h and depth is
/// near / z: column-major.
EglMatrix clipFromWorld(const visibility::LightView& view, int index) {
    const auto& p = view.params;
    const auto* rows = p.lightFromWorld.row;
    const auto i = static_cast<std::size_t>(index);
    const float size = 1 / p.centre, focal = size * p.focal;
    const float kx = size * view.samples[2 * i] * p.near;
    const float ky = size * view.samples[2 * i + 1] * p.near;
    const auto& x = rows[0];
    const auto& y = rows[1];
    const auto& z = rows[2];
    return {focal * x.x,      focal * y.x,      0,      z.x,  //
            focal * x.y,      focal * y.y,      0,      z.y,  //
            focal * x.z,      focal * y.z,      0,      z.z,  //
            focal * x.w - kx, focal * y.w - ky, p.near, z.w};
}

std::uint32_t compile(const std::string& source) {
    const auto shader = glCreateShader(GL_VERTEX_SHADER);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint done = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
    char log[1024] = "";
    if (!done) glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    require(done, "the vertex shader does not compile: {}", log);
    return shader;
}

}  // namespace

EglMaps::EglMaps(const EglContext&, const geometry::Mesh& mesh, const visibility::LightView& view,
                 int held, EglForm form)
    : form_(form), views_(view.params.views), held_(held), resolution_(view.params.resolution) {
    require(form == EglForm::perView || EglContext::has("GL_ARB_shader_viewport_layer_array"),
            "the driver lacks GL_ARB_shader_viewport_layer_array");
    glCreateVertexArrays(1, &vertexArray_);
    glCreateBuffers(2, buffers_);
    uploadMesh(mesh);
    for (int i = 0; i < views_; ++i) matrices_.push_back(clipFromWorld(view, i));
    makeMaps();
    makeProgram();
    require(glGetError() == GL_NO_ERROR, "OpenGL refuses the depth maps");
}

EglMaps::~EglMaps() {
    glDeleteProgram(program_);
    glDeleteFramebuffers(static_cast<GLsizei>(framebuffers_.size()), framebuffers_.data());
    glDeleteTextures(1, &texture_);
    glDeleteBuffers(2, buffers_);
    glDeleteVertexArrays(1, &vertexArray_);
}

/// Vertices and triangles of casters alone; mirrored ones are turned, so that all wind alike.
void EglMaps::uploadMesh(const geometry::Mesh& mesh) {
    const auto indices = mesh.indices.download(0, 3ULL * mesh.triangleCount);
    const auto triangleDraw = mesh.triangleDraw.download(0, mesh.triangleCount);
    const auto draws = mesh.draws.download();
    const auto positions = mesh.positions.download(0, 3ULL * mesh.vertexCount);
    require(!mesh.hasMask && !mesh.hasBlend, "OpenGL draws opaque casters only");
    std::vector<std::uint32_t> kept(mesh.vertexCount, 0), closed, open;
    std::vector<float> vertices;
    for (std::size_t t = 0; t < mesh.triangleCount; ++t) {
        const auto flags = draws[triangleDraw[t]].flags;
        if (!(flags & DRAW_CASTS)) continue;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto corner = flags & DRAW_MIRRORED ? 2 - i : i;
            const auto vertex = indices[3 * t + corner];
            auto& slot = kept[vertex];
            if (slot == 0) {
                const auto* position = &positions[3ULL * vertex];
                vertices.insert(vertices.end(), position, position + 3);
                slot = static_cast<std::uint32_t>(vertices.size() / 3);
            }
            (flags & DRAW_CLOSED ? closed : open).push_back(slot - 1);
        }
    }
    closedIndices_ = static_cast<std::int32_t>(closed.size());
    openIndices_ = static_cast<std::int32_t>(open.size());
    closed.insert(closed.end(), open.begin(), open.end());
    glNamedBufferStorage(buffers_[0], static_cast<GLsizeiptr>(4 * vertices.size()), vertices.data(),
                         0);
    glNamedBufferStorage(buffers_[1], static_cast<GLsizeiptr>(4 * closed.size()), closed.data(), 0);
    glVertexArrayVertexBuffer(vertexArray_, 0, buffers_[0], 0, 12);
    glVertexArrayAttribFormat(vertexArray_, 0, 3, GL_FLOAT, GL_FALSE, 0);
    glEnableVertexArrayAttrib(vertexArray_, 0);
    glVertexArrayElementBuffer(vertexArray_, buffers_[1]);
}

void EglMaps::makeMaps() {
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &texture_);
    glTextureStorage3D(texture_, 1, GL_DEPTH_COMPONENT32F, resolution_, resolution_, held_);
    framebuffers_.resize(form_ == EglForm::perView ? static_cast<std::size_t>(held_) : 1);
    glCreateFramebuffers(static_cast<GLsizei>(framebuffers_.size()), framebuffers_.data());
    for (std::size_t i = 0; i < framebuffers_.size(); ++i) {
        const auto framebuffer = framebuffers_[i];
        if (form_ == EglForm::perView)
            glNamedFramebufferTextureLayer(framebuffer, GL_DEPTH_ATTACHMENT, texture_, 0,
                                           static_cast<GLint>(i));
        else
            glNamedFramebufferTexture(framebuffer, GL_DEPTH_ATTACHMENT, texture_, 0);
        glNamedFramebufferDrawBuffer(framebuffer, GL_NONE);
        glNamedFramebufferReadBuffer(framebuffer, GL_NONE);
        const auto status = glCheckNamedFramebufferStatus(framebuffer, GL_DRAW_FRAMEBUFFER);
        require(status == GL_FRAMEBUFFER_COMPLETE, "framebuffer status 0x{:x}", status);
    }
}

void EglMaps::makeProgram() {
    const char* perView = R"(#version 450 core
        layout(location = 0) uniform mat4 clipFromWorld;
        layout(location = 0) in vec3 position;
        void main() { gl_Position = clipFromWorld * vec4(position, 1); })";
    constexpr const char* layered = R"(#version 450 core
        #extension GL_ARB_shader_viewport_layer_array : require
        layout(location = 0) uniform mat4 clipFromWorld[{}];
        layout(location = 0) in vec3 position;
        void main() {{
            gl_Position = clipFromWorld[gl_InstanceID] * vec4(position, 1);
            gl_Layer = gl_InstanceID;
        }})";
    const auto shader = compile(form_ == EglForm::perView ? perView : fmt::format(layered, held_));
    program_ = glCreateProgram();
    glAttachShader(program_, shader);
    glLinkProgram(program_);
    glDeleteShader(shader);
    GLint done = 0;
    glGetProgramiv(program_, GL_LINK_STATUS, &done);
    require(done, "the OpenGL program does not link");
}

void EglMaps::draw(int instances) const {
    const auto part = [&](std::int32_t count, std::int32_t first) {
        const auto* offset = reinterpret_cast<const void*>(4 * static_cast<std::size_t>(first));
        if (count > 0)
            glDrawElementsInstanced(GL_TRIANGLES, count, GL_UNSIGNED_INT, offset, instances);
    };
    glEnable(GL_CULL_FACE);
    part(closedIndices_, 0);
    glDisable(GL_CULL_FACE);
    part(openIndices_, closedIndices_);
}

void EglMaps::run() {
    glUseProgram(program_);
    glBindVertexArray(vertexArray_);
    glViewport(0, 0, resolution_, resolution_);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glClearDepth(0);
    glFrontFace(GL_CW);  // rows go down in maps and up in OpenGL
    const int step = form_ == EglForm::perView ? 1 : held_;
    for (int first = 0; first < views_; first += step) {
        const auto target = static_cast<std::size_t>(first % held_) % framebuffers_.size();
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffers_[target]);
        glClear(GL_DEPTH_BUFFER_BIT);
        const int instances = std::min(step, views_ - first);
        glUniformMatrix4fv(0, instances, GL_FALSE,
                           matrices_[static_cast<std::size_t>(first)].data());
        draw(instances);
    }
    glFinish();
}

std::vector<float> EglMaps::download(int map) const {
    std::vector<float> depths(static_cast<std::size_t>(resolution_) *
                              static_cast<std::size_t>(resolution_));
    glGetTextureSubImage(texture_, 0, 0, 0, map, resolution_, resolution_, 1, GL_DEPTH_COMPONENT,
                         GL_FLOAT, static_cast<GLsizei>(4 * depths.size()), depths.data());
    return depths;
}

}  // namespace penumbra::bench
