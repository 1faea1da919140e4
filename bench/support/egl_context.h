// SPDX-License-Identifier: MIT
// An OpenGL context without a window, for rivals that draw with OpenGL.
#pragma once
#include <string>

namespace penumbra::bench {

/// OpenGL 4.5 core through EGL's surfaceless platform, current in the thread that makes it, drawn
/// by Mesa's llvmpipe. One at a time. Throws Error with the step that failed.
class EglContext {
  public:
    /// `threads` of llvmpipe's rasteriser beside the caller's, which transforms and bins; 0: the
    /// caller's does all.
    explicit EglContext(int threads);
    ~EglContext();
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;

    /// Renderer, version and threads, for labels.
    const std::string& description() const { return description_; }
    /// True if the driver has the extension.
    static bool has(const std::string& extension);

  private:
    void* display_ = nullptr;
    void* context_ = nullptr;
    std::string description_;
};

}  // namespace penumbra::bench
