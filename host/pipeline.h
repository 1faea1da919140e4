// SPDX-License-Identifier: MIT
// A frame from a scene: the passes in their order.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "host/gbuffer/gbuffer.h"
#include "host/geometry/geometry.h"
#include "host/penumbra.h"
#include "host/scene/animation.h"
#include "host/scene/bounds.h"
#include "host/scene/camera.h"
#include "host/scene/light.h"
#include "host/shading/composite.h"
#include "host/shading/shade.h"
#include "host/shading/temporal.h"
#include "host/visibility/technique.h"
#include "runtime/profiler.h"

namespace penumbra {

/// Which extra channels a frame carries.
struct AovChoice {
    bool visibility = false, depth = false, normal = false, position = false, albedo = false,
         id = false, depthMaps = false, mask = false;
};
/// Throws Error (usage) naming what is allowed.
AovChoice parseAovs(const std::vector<std::string>& names);

/// Loads options.scene, adds ground and lights as the options say.
scene::Scene loadScene(const RenderOptions& options);

class Pipeline {
  public:
    explicit Pipeline(const RenderOptions& options);
    /// `device`: opened as the options say where there is none.
    Pipeline(const RenderOptions& options, scene::Scene scene,
             std::unique_ptr<runtime::Device> device = nullptr);
    ~Pipeline();

    Frame render(int number);
    int frameCount() const;
    std::vector<std::string> takeWarnings();
    runtime::Device& device() { return *device_; }
    const std::string& fingerprint() const { return fingerprint_; }
    std::string statsJson() const;
    const scene::Bounds& bounds() const { return bounds_; }
    /// Keeps which pixels were tested (waits for the device in each frame).
    void keepStates(bool keep) { keepStates_ = keep; }
    /// Pixels [height, width] of the last frame that some light can reach: neither background nor
    /// facing away. Needs keepStates.
    std::vector<bool> testedPixels() const;

  private:
    double secondsOf(int number) const;
    scene::CameraFrame cameraOf(const scene::Pose& pose) const;
    void makePasses();
    /// After an error in the middle of a frame: the next one is rendered with passes made anew, as
    /// lists may be half grown, counters half read, and memory scarce.
    void dropPasses();
    void checkLight(const scene::AreaLight& light);
    /// Runs the G-buffer at the clip's start until the lists of blended fragments fit (waits), so
    /// that the plan and what follows know their length.
    void sizeLists();
    /// Makes what has an entry for each pixel of the G-buffer, blended fragments included; anew
    /// where their number has grown.
    void makeForPixels();
    /// What can be said before anything is allocated, and what the first frame will add to what is
    /// held then. Throw Error (exit code 4) with the figures where that does not fit.
    void planScene() const;
    std::uint64_t planFrame() const;
    /// Renders into the device's images; repeats where a list was too short. Returns the
    /// repetitions.
    int renderOnDevice(int number, bool keep);
    Frame renderFrame(int number);
    void enqueue(const geometry::Mesh& mesh, bool keep);
    bool anyListGrew();
    void keepOutputs(std::size_t light);
    Frame collect(int number);
    std::string frameStats(const std::vector<runtime::StageTime>& stages, int number, double wallMs,
                           int retries);
    std::vector<std::pair<std::string, std::string>> makeHeader() const;
    /// `about`: the warning without figures that differ from frame to frame.
    void warnOnce(const std::string& warning, const std::string& about = "");

    RenderOptions options_;
    AovChoice aovs_;
    std::unique_ptr<runtime::Device> device_;
    scene::Scene scene_;
    std::vector<int> clips_;
    scene::Bounds bounds_;
    std::string sceneDigest_;
    int width_, height_;  ///< of the G-buffer: the frame's times supersample
    std::unique_ptr<runtime::Program> program_;
    std::unique_ptr<geometry::Geometry> geometry_;
    std::unique_ptr<gbuffer::GBufferPass> gbuffer_;
    std::unique_ptr<visibility::Technique> technique_;
    std::unique_ptr<shading::Shade> shade_;
    std::unique_ptr<shading::Temporal> temporal_;
    std::unique_ptr<shading::Composite> composite_;  ///< null: nothing is blended
    visibility::Visibility visibility_;
    int madeForRows_ = 0;                             ///< of the G-buffer
    std::vector<std::vector<float>> keptVisibility_;  ///< per light, when asked for
    std::vector<visibility::DepthMaps> keptMaps_;
    std::vector<visibility::OcclusionMasks> keptMasks_;
    bool keepStates_ = false;
    std::vector<std::vector<std::uint32_t>> keptStates_;  ///< per light, when asked for
    std::vector<scene::AreaLight> lights_;                ///< of the frame in flight
    scene::CameraFrame camera_;
    double exposure_ = 1;
    std::uint64_t plannedBytes_ = 0, maskBytes_ = 0;
    glm::dvec3 ambient_{0};
    std::vector<std::pair<std::string, std::string>> header_;  ///< of all frames
    std::string fingerprint_;
    std::vector<std::string> warnings_, warned_;
    std::optional<int> lastFrame_;  ///< whose history the temporal pass holds
};

}  // namespace penumbra
