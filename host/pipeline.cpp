// SPDX-License-Identifier: MIT
#include "host/pipeline.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "host/image/frame_planes.h"
#include "host/scene/builtin.h"
#include "host/scene/digest.h"
#include "host/scene/gltf_loader.h"
#include "kernels/shared/multi_view.h"
#include "runtime/digest.h"
#include "runtime/error.h"
#include "runtime/slow_notice.h"

namespace penumbra {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kAmbient = 0.05, kWhite = 0.8;
constexpr int kMaxRetries = 6;
constexpr double kMaxCoordinate = 1e12;  // of the camera, metres
constexpr int kMaxFrames = 1 << 30;      // of a clip; --frames takes fewer
constexpr std::uint64_t kMaxMegabytes = 1 << 30;

std::unique_ptr<runtime::Device> openDevice(const RenderOptions& options) {
    const auto devices = runtime::listDevices();
    const auto choice = runtime::chooseDevice(devices, options.device);
    runtime::DeviceOptions deviceOptions;
    deviceOptions.profiling = options.profile;
    deviceOptions.cache = options.cache;
    deviceOptions.memoryLimitBytes = options.memoryMegabytes * 1024 * 1024;
    return std::make_unique<runtime::Device>(devices[choice.index], deviceOptions);
}

glm::dvec3 vectorOf(const std::vector<double>& v, const char* option) {
    requireUsage(v.size() == 3, "{} needs three numbers x,y,z, got {}", option, v.size());
    for (const double number : v)
        requireUsage(std::abs(number) <= kMaxCoordinate, "{} {},{},{} is outside of -{} to {} m",
                     option, v[0], v[1], v[2], kMaxCoordinate, kMaxCoordinate);
    return {v[0], v[1], v[2]};
}

scene::CameraChoice cameraChoice(const RenderOptions& options) {
    scene::CameraChoice choice;
    choice.name = options.camera;
    if (options.eye) choice.eye = vectorOf(*options.eye, "--eye");
    if (options.target) choice.target = vectorOf(*options.target, "--target");
    choice.fovDegrees = options.fovDegrees;
    return choice;
}

scene::SampleChoice sampleChoice(const RenderOptions& options, int frame) {
    scene::SampleChoice choice;
    choice.pattern = scene::parsePattern(options.lightPattern);
    choice = scene::parseSampleCount(options.lightSamples, choice);
    choice.seed = scene::parseSeed(options.seed, frame);
    return choice;
}

std::size_t drawnTriangles(const scene::Scene& scene) {
    std::size_t count = 0;
    for (const int node : scene.order) {
        const int mesh = scene.nodes[static_cast<std::size_t>(node)].mesh;
        if (mesh < 0) continue;
        for (const auto& p : scene.meshes[static_cast<std::size_t>(mesh)].primitives)
            count += p.indices.size() / 3;
    }
    return count;
}

double exposureOf(const RenderOptions& options, const glm::dvec3& irradiance) {
    if (options.exposure == "auto") {
        const double white =
            (irradiance.x + irradiance.y + irradiance.z) / 3 / kPi * (1 + kAmbient);
        return white > 0 ? kWhite / white : 1;
    }
    try {
        std::size_t used = 0;
        const double ev = std::stod(options.exposure, &used);
        if (used == options.exposure.size() && std::abs(ev) <= 64) return std::exp2(ev);
    } catch (const std::exception&) {
    }
    throw Error(fmt::format("--exposure '{}' is neither a number of stops, -64 to 64, nor 'auto'",
                            options.exposure),
                ExitCode::usage);
}

}  // namespace

AovChoice parseAovs(const std::vector<std::string>& names) {
    AovChoice aovs;
    const std::pair<const char*, bool AovChoice::*> all[] = {
        {"visibility", &AovChoice::visibility}, {"depth", &AovChoice::depth},
        {"normal", &AovChoice::normal},         {"position", &AovChoice::position},
        {"albedo", &AovChoice::albedo},         {"id", &AovChoice::id},
        {"depth-maps", &AovChoice::depthMaps},  {"mask", &AovChoice::mask}};
    for (const auto& name : names) {
        bool known = name == "all";
        for (const auto& [key, member] : all)
            // "all" leaves out depth maps and masks, which are gigabytes
            if (name == key ||
                (name == "all" && member != &AovChoice::depthMaps && member != &AovChoice::mask))
                aovs.*member = known = true;
        requireUsage(
            known,
            "--aov '{}' is unknown; allowed: all, visibility, depth, normal, position, albedo, id, "
            "depth-maps, mask",
            name);
    }
    return aovs;
}

scene::Scene loadScene(const RenderOptions& options) {
    auto scene = options.scene.empty() ? scene::loadBuiltinScene() : scene::loadGltf(options.scene);
    if (!options.lights.empty()) {
        scene.lights.clear();
        for (const auto& text : options.lights) scene.lights.push_back(scene::parseLight(text));
    } else if (scene.lights.empty()) {
        scene.warnings.push_back(
            "the scene has no light that can be used: a square light is placed above it; "
            "choose your own with --light");
    }
    return scene;
}

Pipeline::Pipeline(const RenderOptions& options) : Pipeline(options, loadScene(options)) {}

Pipeline::Pipeline(const RenderOptions& options, scene::Scene scene,
                   std::unique_ptr<runtime::Device> device)
    : options_(options),
      aovs_(parseAovs(options.aovs)),
      device_(std::move(device)),
      scene_(std::move(scene)) {
    requireUsage(options.supersample >= 1 && options.supersample <= 8,
                 "--supersample {} is outside of 1 to 8", options.supersample);
    requireUsage(options.fps > 0 && std::isfinite(options.fps),
                 "--fps {} is not a number greater than 0", options.fps);
    requireUsage(options.memoryMegabytes <= kMaxMegabytes, "--memory {} is outside of 0 to {} MB",
                 options.memoryMegabytes, kMaxMegabytes);
    requireUsage(options.temporal >= 0 && options.temporal <= 64,
                 "--temporal {} is outside of 0 to 64", options.temporal);
    requireUsage(options.width > 0 && options.height > 0 && options.width <= RASTER_MAX_SIZE &&
                     options.height <= RASTER_MAX_SIZE,
                 "--size {}x{} is outside of 1x1 to {}x{} pixels", options.width, options.height,
                 RASTER_MAX_SIZE, RASTER_MAX_SIZE);
    visibility::findTechnique(options.technique);
    const auto pattern = sampleChoice(options, 0).pattern;
    requireUsage(pattern != scene::Pattern::random || options.technique == "raytrace",
                 "--light-pattern random gives each pixel samples of its own, which only technique "
                 "raytrace can use; allowed for {}: hammersley, poisson, grid, jittered",
                 options.technique);
    width_ = options.width * options.supersample;
    height_ = options.height * options.supersample;
    clips_ = scene::chooseAnimations(scene_, options.animation);
    bounds_ = scene::clipBounds(scene_, clips_);
    const std::size_t drawn = drawnTriangles(scene_);
    if (options.ground) scene::addGround(scene_, bounds_);
    require(drawnTriangles(scene_) > 0, "{}: no triangles to draw; add --ground for an empty floor",
            options.scene.empty() ? "built-in scene" : options.scene);
    for (const auto& warning : scene_.warnings) warnOnce(warning);
    if (drawn > 0 && bounds_.empty) warnOnce("no vertex of the scene is finite: it has no bounds");
    if (drawn > 0 && !bounds_.empty && bounds_.radius() == 0)
        warnOnce(
            fmt::format("all vertices of the scene lie at one point, {},{},{}: nothing of it "
                        "can be seen",
                        bounds_.low.x, bounds_.low.y, bounds_.low.z));

    const auto pose = scene::poseAt(scene_, clips_, 0);
    glm::dvec3 irradiance(0);
    const auto choice = sampleChoice(options_, 0);
    for (const auto& light : scene::lightsAt(scene_, pose, bounds_, choice)) {
        irradiance += scene::facingIrradiance(light, bounds_.centre());
        const auto count = static_cast<int>(light.samples.size());
        if (count != choice.count && !light.isPoint())
            warnOnce(fmt::format("light '{}': {} of {} cells lie on the disk: {} samples",
                                 light.name, count, choice.count, count));
        if (light.isPoint())
            warnOnce(
                fmt::format("light '{}' has no size: hard shadows with one sample", light.name));
    }
    exposure_ = exposureOf(options_, irradiance);
    ambient_ = kAmbient * irradiance / kPi;

    if (!device_) device_ = openDevice(options_);
    planScene();
    makePasses();
    for (const auto& light : scene::lightsAt(scene_, pose, bounds_, choice)) checkLight(light);
    plannedBytes_ = planFrame();
    std::string key = scene::sceneDigest(scene_);
    header_ = makeHeader();
    for (const auto& [name, value] : header_) key += fmt::format("{}={}\n", name, value);
    fingerprint_ = runtime::digest(key);
}

Pipeline::~Pipeline() = default;

scene::CameraFrame Pipeline::cameraOf(const scene::Pose& pose) const {
    return scene::cameraAt(scene_, pose, cameraChoice(options_), bounds_,
                           static_cast<double>(options_.width) / options_.height);
}

void Pipeline::checkLight(const scene::AreaLight& light) {
    technique_->check(light);
    if (!aovs_.mask) return;
    const auto bytes = technique_->maskBytes(light);
    requireUsage(bytes > 0, "--aov mask: technique {} makes no occlusion masks; raster4d does",
                 options_.technique);
    maskBytes_ = std::max(maskBytes_, bytes);
}

double Pipeline::secondsOf(int number) const {
    return std::clamp(number / options_.fps, 0.0, scene::clipDurationSeconds(scene_, clips_));
}

int Pipeline::frameCount() const {
    const double last =
        std::floor(scene::clipDurationSeconds(scene_, clips_) * options_.fps + 1e-6);
    return static_cast<int>(std::min<double>(last, kMaxFrames)) + 1;
}

void Pipeline::enqueue(const geometry::Mesh& mesh, bool keep) {
    const gbuffer::GBuffer& gbuffer = gbuffer_->run(mesh, camera_, bounds_.centre());
    shade_->begin(gbuffer, ambient_);
    technique_->prepare(mesh, bounds_, bounds_.centre());
    keptVisibility_.clear();
    keptMaps_.clear();
    keptMasks_.clear();
    keptStates_.clear();
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        visibility::DepthMaps maps;
        visibility::OcclusionMasks masks;
        technique_->run(
            {mesh, gbuffer, lights_[i], bounds_, bounds_.centre(),
             keep && aovs_.depthMaps ? &maps : nullptr, keep && aovs_.mask ? &masks : nullptr},
            visibility_);
        temporal_->run(gbuffer, i, visibility_);
        shade_->add(gbuffer, lights_[i], visibility_, camera_, bounds_.centre());
        if (keep && keepStates_) keptStates_.push_back(visibility_.state.download());
        if (keep && aovs_.visibility) keptVisibility_.push_back(visibility_.planes.download());
        if (keep && aovs_.depthMaps) keptMaps_.push_back(std::move(maps));
        if (keep && aovs_.mask) keptMasks_.push_back(std::move(masks));
    }
    if (composite_) composite_->run(gbuffer, shade_->colour());
}

bool Pipeline::anyListGrew() {
    const bool camera = gbuffer_->grew();
    return technique_->grew() || camera;
}

int Pipeline::renderOnDevice(int number, bool keep) {
    const scene::Pose pose = scene::poseAt(scene_, clips_, secondsOf(number));
    camera_ = cameraOf(pose);
    lights_ = scene::lightsAt(scene_, pose, bounds_, sampleChoice(options_, number));
    const geometry::Mesh& mesh = geometry_->run(pose);
    int retries = 0;
    for (;; ++retries) {
        enqueue(mesh, keep);
        if (!anyListGrew()) break;
        require(retries < kMaxRetries, "frame {}: device lists still overflow after {} attempts",
                number, retries);
        temporal_->undo();
        technique_->takeCounts();
        makeForPixels();
    }
    temporal_->endFrame(gbuffer_->result(), camera_, bounds_.centre());
    lastFrame_ = number;
    return retries;
}

Frame Pipeline::render(int number) try {
    if (!gbuffer_) makePasses();
    return renderFrame(number);
} catch (const std::exception&) {
    dropPasses();
    throw;
}

Frame Pipeline::renderFrame(int number) {
    std::optional<runtime::SlowNotice> notice;  // later frames are slow for their own reasons
    if (!lastFrame_) notice.emplace("preparing kernels for their first use on this device");
    const int window = options_.temporal;
    if (window > 1 && (!lastFrame_ || *lastFrame_ != number - 1)) {
        temporal_->reset();
        for (int f = number - window + 1; f < number; ++f) {
            renderOnDevice(f, false);
            technique_->takeCounts();
        }
        device_->profiler().collect();
    }
    const auto start = std::chrono::steady_clock::now();
    const int retries = renderOnDevice(number, true);
    for (const auto& warning : technique_->warnings()) warnOnce(warning);
    const auto stages = device_->profiler().collect();
    Frame frame = collect(number);
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
    frame.statsJson = frameStats(stages, number, wall.count(), retries);
    return frame;
}

Frame Pipeline::collect(int number) {
    image::FramePlanes planes;
    planes.width = options_.width;
    planes.height = options_.height;
    planes.supersample = options_.supersample;
    planes.stride = gbuffer_->result().planeStride;
    planes.colour = shade_->colour().download();
    if (composite_) {
        planes.alpha = composite_->alpha().download();
        planes.front = composite_->front().download();
    }
    const bool surfaces = aovs_.depth || aovs_.normal || aovs_.position || aovs_.albedo || aovs_.id;
    const auto stride = static_cast<std::uint64_t>(planes.stride);
    const auto& source = gbuffer_->result().planes;
    if (surfaces)
        planes.gbuffer = source.download();
    else
        planes.objects = source.download(GB_OBJECT * stride, stride);
    Frame frame = image::assembleFrame(planes, aovs_, bounds_.centre());
    for (std::size_t i = 0; i < keptVisibility_.size(); ++i)
        image::addVisibility(planes, lights_[i].name, keptVisibility_[i], frame);
    for (std::size_t i = 0; i < keptMaps_.size(); ++i)
        image::addDepthMaps(lights_[i].name, keptMaps_[i], frame);
    for (std::size_t i = 0; i < keptMasks_.size(); ++i)
        image::addMasks(planes, lights_[i].name, keptMasks_[i], frame);
    frame.number = number;
    frame.exposure = exposure_;
    frame.header = header_;
    frame.fingerprint = fingerprint_;
    return frame;
}

std::vector<bool> Pipeline::testedPixels() const {
    const auto n = static_cast<std::size_t>(options_.supersample);
    const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
    std::vector<std::uint32_t> front(width * height);
    std::iota(front.begin(), front.end(), 0U);
    if (composite_) front = composite_->front().download();
    std::vector<bool> tested((width / n) * (height / n), false);
    for (const auto& states : keptStates_)
        for (std::size_t y = 0; y < height; ++y)
            for (std::size_t x = 0; x < width; ++x)
                if (states[front[y * width + x]] == STATE_TESTED)
                    tested[y / n * (width / n) + x / n] = true;
    return tested;
}

void Pipeline::warnOnce(const std::string& warning, const std::string& about) {
    const auto& key = about.empty() ? warning : about;
    if (std::find(warned_.begin(), warned_.end(), key) != warned_.end()) return;
    warned_.push_back(key);
    warnings_.push_back(warning);
}

std::vector<std::string> Pipeline::takeWarnings() {
    for (const auto& warning : device_->takeWarnings()) warnOnce(warning);
    return std::exchange(warnings_, {});
}

}  // namespace penumbra
