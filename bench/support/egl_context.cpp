// SPDX-License-Identifier: MIT
#include "bench/support/egl_context.h"

#define EGL_NO_X11
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>
#include <fmt/format.h>

#include <cstdlib>

#include "runtime/error.h"

namespace penumbra::bench {
namespace {

void step(bool done, const char* what) {
    if (!done) throw Error(fmt::format("{} failed: EGL error 0x{:x}", what, eglGetError()));
}

std::string text(GLenum name) {
    const auto* value = glGetString(name);
    return value ? reinterpret_cast<const char*>(value) : "";
}

}  // namespace

EglContext::EglContext(int threads) {
    // Mesa reads these when a display is initialised
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
    display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    step(display_ != EGL_NO_DISPLAY, "opening the surfaceless display");
    step(eglInitialize(display_, nullptr, nullptr), "initialising EGL");
    step(eglBindAPI(EGL_OPENGL_API), "choosing OpenGL");
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
    context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    step(context_ != EGL_NO_CONTEXT, "making an OpenGL 4.5 core context");
    step(eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_),
         "making the context current");
    const auto renderer = text(GL_RENDERER);
    description_ = renderer + ", " + text(GL_VERSION);
    if (renderer.find("llvmpipe") != std::string::npos)
        description_ += fmt::format(", LP_NUM_THREADS={}", threads);
}

EglContext::~EglContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglTerminate(display_);
}

bool EglContext::has(const std::string& extension) {
    GLint count = 0;
    glGetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i)
        if (extension == reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, i))) return true;
    return false;
}

}  // namespace penumbra::bench
