// SPDX-License-Identifier: MIT
// penumbra: multi-view depth warping and accurate soft shadows for animated glTF scenes, in OpenCL.
//
//   penumbra::RenderOptions options;
//   options.scene = "figure.glb";
//   penumbra::Renderer renderer(options);
//   for (int f = 0; f < renderer.frameCount(); ++f)
//       penumbra::writePng("out.png", renderer.render(f));
//
// Units: metres, seconds; degrees where a name says so. Errors are std::runtime_error with a
// one-line message; exitCodeOf() tells their kind.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace penumbra {

/// What to render and how; the options of `penumbra render`.
struct RenderOptions {
    std::string scene;  ///< .gltf or .glb; empty: the built-in scene
    std::string technique = "vwss";
    std::map<std::string, std::string> settings;  ///< "vwss.pcf" -> "9"; see techniquesJson()
    int width = 1280, height = 720;               ///< pixels
    int supersample = 1;                          ///< samples along each side of a pixel, 1 to 8
    double fps = 24;
    std::string animation;  ///< name, index, "none"; empty: clip 0 and what moves other nodes
    std::string camera;     ///< name, index, "auto"; empty: the file's first, else auto
    std::optional<std::vector<double>> eye, target;  ///< three numbers, metres
    std::optional<double> fovDegrees;                ///< vertical
    bool ground = false;                             ///< a square of 20 R under the scene
    std::vector<std::string>
        lights;  ///< "rect:at=0,4,0;aim=0,0,0;size=1x1;radiance=20"; replace the file's
    std::string lightSamples = "64";  ///< N or MxN
    std::string lightPattern = "hammersley";
    std::string seed = "0";         ///< a number, or "frame": another for each frame
    int temporal = 0;               ///< frames averaged
    std::string exposure = "auto";  ///< or EV: stops of gain
    std::vector<std::string> aovs;  ///< visibility depth normal position albedo id depth-maps all
    std::string device;  ///< cpu, gpu, index, platform:device, part of a name; empty: the best
    std::uint64_t memoryMegabytes = 0;  ///< limit on device memory; 0: the device's
    bool cache = true;                  ///< keep compiled programs on disk
    bool profile = false;               ///< time every stage (statsJson)
};

/// One named plane of a frame: `values` or `ids` has width * height elements, rows from the top.
struct Channel {
    std::string name;
    std::vector<float> values;
    std::vector<std::uint32_t> ids;
};

/// A rendered frame.
struct Frame {
    int number = 0, width = 0, height = 0;
    std::vector<float> rgba;        ///< [height, width, 4] linear, scene-referred; alpha = coverage
    std::vector<Channel> channels;  ///< Z, P.X ..., visibility.<light>.R ..., as asked for
    double exposure = 1;            ///< gain for looking; the same for all frames of a sequence
    /// Depth maps, one list of planes "<light>.<view>" of depthMapSize^2 each; empty unless asked
    /// for.
    std::vector<Channel> depthMaps;
    int depthMapSize = 0;
    /// Occlusion masks, one list of planes "<light>.<row>.<word>" of maskWidth x maskHeight each:
    /// bit j of word w is set if the light sample in column 32 w + j of that row is hidden. Empty
    /// unless asked for. Of all supersamples.
    std::vector<Channel> masks;
    int maskWidth = 0, maskHeight = 0;
    std::vector<std::pair<std::string, std::string>> maskCells;  ///< light -> "COLUMNSxROWS"
    std::vector<std::pair<std::string, std::string>> header;     ///< what made it; goes into files
    std::string fingerprint;  ///< equal if scene, options, device and version are
    std::string statsJson;    ///< measurements of this frame, a JSON object
};

class Renderer {
  public:
    explicit Renderer(const RenderOptions& options);
    ~Renderer();
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;

    /// Renders frame `number` at number / fps seconds, clamped to the clip. The result depends on
    /// nothing rendered before, be it frames or errors.
    Frame render(int number);
    /// Frames of the clip: 0 .. frameCount() - 1; 1 for a still scene.
    int frameCount() const;
    /// What was ignored, replaced or given up since the last call, one line each.
    std::vector<std::string> takeWarnings();
    std::string deviceName() const;
    /// Fingerprint that all frames of this renderer carry.
    std::string fingerprint() const;
    /// JSON: device, settings, programs, memory; see README.
    std::string statsJson() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Writes linear half RGBA and the channels, ZIP; depth maps go to NAME.depth-maps.exr beside it.
void writeExr(const std::string& path, const Frame& frame);
/// Writes tone-mapped 8-bit sRGB.
void writePng(const std::string& path, const Frame& frame);
/// Where writeExr puts the depth maps of a frame.
std::string depthMapsPath(const std::string& framePath);
/// Where writeExr puts the occlusion masks of a frame.
std::string masksPath(const std::string& framePath);
/// Fingerprint in a whole EXR or PNG file; empty if there is none or the file is damaged.
std::string readFingerprint(const std::string& path);

/// JSON texts of `penumbra devices`, `techniques`, `info`.
std::string devicesJson(const std::string& requested = "");
std::string techniquesJson();
std::string infoJson(const std::string& scene);

/// 0 done, 1 failed, 2 usage, 3 no device, 4 out of memory, 5 beyond a limit, 130 interrupted.
int exitCodeOf(const std::exception& error);
/// "0.1.0"
const char* version();

}  // namespace penumbra
