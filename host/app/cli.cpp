// SPDX-License-Identifier: MIT
// The command line: arguments -> options. No algorithms.
#include "host/app/cli.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>

#include "host/app/commands.h"
#include "host/app/config_file.h"
#include "runtime/error.h"

namespace penumbra::app {
namespace {

/// Arguments of all commands, filled by CLI11.
struct Arguments {
    RenderArguments render;
    CompareArguments compare;
    DiffArguments diff;
    std::string size = "1280x720", scene, device, config;
    std::vector<std::string> settings;
    std::vector<double> eye, target;
    double fov = 0;
    bool json = false, verbose = false, noCache = false;
};

void parseSize(const std::string& text, RenderOptions& options) {
    const char* const end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, options.width);
    const bool crossed = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
    const auto height = std::from_chars(crossed ? width.ptr + 1 : end, end, options.height);
    requireUsage(crossed && height.ec == std::errc() && height.ptr == end && options.width > 0 &&
                     options.height > 0,
                 "--size '{}' is not WIDTHxHEIGHT in pixels", text);
}

void parseSettings(const std::vector<std::string>& texts, RenderOptions& options) {
    for (const auto& text : texts) {
        const auto equals = text.find('=');
        const auto dot = text.find('.');
        requireUsage(equals != std::string::npos && dot < equals,
                     "--set '{}' is not technique.setting=value; see `penumbra techniques`", text);
        options.settings[text.substr(0, equals)] = text.substr(equals + 1);
    }
}

void requireOwnSettings(const RenderOptions& options) {
    for (const auto& [key, value] : options.settings) {
        const auto technique = key.substr(0, key.find('.'));
        requireUsage(technique == options.technique,
                     "--set '{}={}' is for {}, and --technique is {}", key, value, technique,
                     options.technique);
    }
}

void addScene(CLI::App& command, Arguments& a) {
    command.add_option("SCENE", a.scene, ".gltf or .glb; the built-in scene where none is named");
}

/// An option that may be given several times, with one value each: what follows is not swallowed.
void addRepeated(CLI::App& command, const char* name, std::vector<std::string>& values,
                 const char* help) {
    command.add_option(name, values, help)->allow_extra_args(false);
}

void addCamera(CLI::App& render, Arguments& a) {
    auto& o = a.render.options;
    render.add_option("--camera", o.camera,
                      "name or index of a camera, or auto; default: the file's first, else auto");
    render.add_option("--eye", a.eye, "camera position x,y,z in metres")
        ->delimiter(',')
        ->expected(3);
    render.add_option("--target", a.target, "point the camera looks at, x,y,z")
        ->delimiter(',')
        ->expected(3);
    render.add_option("--fov", a.fov, "vertical field of view, degrees");
}

void addLights(CLI::App& render, Arguments& a) {
    auto& o = a.render.options;
    addRepeated(render, "--light", o.lights,
                "rect:at=0,4,0;aim=0,0,0;up=0,0,1;size=1x1;radiance=20 (disk:, sphere: with "
                "radius=; fov=, near=, name=); replaces the file's lights; repeatable");
    render
        .add_option("--light-samples", o.lightSamples,
                    "samples of each light: N, or MxN for a grid")
        ->capture_default_str();
    render
        .add_option("--light-pattern", o.lightPattern,
                    "hammersley, poisson, grid, jittered; raytrace: also random, anew in each "
                    "pixel")
        ->capture_default_str();
    render
        .add_option("--seed", o.seed, "of the pattern: a number, or frame for another each frame")
        ->capture_default_str();
}

void addOutput(CLI::App& render, Arguments& a) {
    auto& r = a.render;
    auto& o = r.options;
    render.add_option("-o,--output", r.output, "file: .exr or .png; #### is the frame number")
        ->required();
    render.add_option("--frames", r.frames, "1,3,5..10 or 0..119 or all")->capture_default_str();
    render
        .add_option("--aov", o.aovs,
                    "extra channels of EXR files: all, visibility, depth, normal, position, "
                    "albedo, id, depth-maps, mask")
        ->allow_extra_args(false)
        ->delimiter(',');
    render.add_flag("--resume", r.resume, "skip whole frames of the same fingerprint");
    render.add_option("--stats", r.stats, "write measurements as JSON");
}

/// What is rendered and on what, of render and compare alike.
void addPicture(CLI::App& command, Arguments& a) {
    auto& o = a.render.options;
    addScene(command, a);
    command.add_option("--fps", o.fps, "frames per second")->capture_default_str();
    command.add_option("--size", a.size, "pixels")->capture_default_str();
    command
        .add_option("--supersample", o.supersample, "samples along each side of a pixel, 1 to 8")
        ->capture_default_str();
    command
        .add_option("--exposure", o.exposure,
                    "of PNG files: auto (white at the scene's centre is 0.8) or stops")
        ->capture_default_str();
    command.add_option("--temporal", o.temporal, "frames that visibility is averaged over")
        ->capture_default_str();
    addRepeated(command, "--set", a.settings, "technique.setting=value; repeatable");
    addLights(command, a);
    addCamera(command, a);
    command.add_flag("--ground", o.ground, "put a floor under the scene");
    command.add_option(
        "--animation", o.animation,
        "name, index, all, or none; default (all): clip 0 and what moves other nodes");
    command.add_option("--device", a.device,
                       "cpu, gpu, an index, platform:device, or part of a name");
    command.add_option("--memory", o.memoryMegabytes, "limit on device memory, MB")
        ->check(CLI::Range(0, 1 << 30));
    command.add_flag("--no-cache", a.noCache, "compile kernels anew");
}

CLI::App* addRender(CLI::App& app, Arguments& a) {
    auto& render = *app.add_subcommand("render", "Render frames");
    addPicture(render, a);
    addOutput(render, a);
    render.add_option("--technique", a.render.options.technique, "see `penumbra techniques`")
        ->capture_default_str();
    render.add_flag("-q,--quiet", a.render.quiet, "only errors on stderr");
    render.add_flag("-v,--verbose", a.render.verbose,
                    "device, and a table of milliseconds per stage, on stderr");
    render.add_option("--config", a.config, "read options from a TOML file; the command line wins");
    return &render;
}

CLI::App* addCompare(CLI::App& app, Arguments& a) {
    auto& compare = *app.add_subcommand(
        "compare", "Render a scene with several techniques: a page with cost and error of each");
    auto& c = a.compare;
    addPicture(compare, a);
    compare
        .add_option("--techniques", c.techniques,
                    "vwss,mvr:pcf=9:resolution=512,...; settings of a technique, and samples=, "
                    "pattern=, seed=, temporal=, after colons")
        ->required()
        ->allow_extra_args(false)
        ->delimiter(',');
    compare
        .add_option("--reference", c.reference,
                    "a technique, or an EXR file of another renderer (#### is the frame)")
        ->capture_default_str();
    compare
        .add_option("--reference-samples", c.referenceSamples,
                    "light samples of a reference that is a technique")
        ->capture_default_str();
    compare.add_option("--report", c.report, "folder of the page, EXR files and results.json")
        ->required();
    compare.add_option("--frames", c.frames, "1,3,5..10 or 0..119")->capture_default_str();
    compare.add_option("--repeats", c.repeats, "timings of a single frame; the median counts")
        ->capture_default_str();
    compare.add_option("--sweep", c.sweep,
                       "light-samples=8,16,32 or a setting with values: error and time against it");
    compare.add_flag("--json", c.json, "results.json on stdout");
    compare.add_flag("-q,--quiet", c.quiet, "only errors on stderr");
    return &compare;
}

CLI::App* addDiff(CLI::App& app, Arguments& a) {
    auto& diff = *app.add_subcommand("diff", "Compare two images; exit code 5 beyond a limit");
    diff.add_option("A", a.diff.a, ".exr or .png")->required();
    diff.add_option("B", a.diff.b, ".exr or .png")->required();
    diff.add_option("--layer", a.diff.layer, "RGB, visibility.<light>, Z, ...");
    diff.add_option("--mask", a.diff.mask, "image; only pixels above 0.5 count");
    diff.add_option("--fail-rmse", a.diff.failRmse, "largest root mean square difference");
    diff.add_option("--fail-max", a.diff.failMax, "largest difference");
    diff.add_option("--fail-psnr", a.diff.failPsnr, "least peak signal-to-noise ratio, dB");
    diff.add_option("--fail-ssim", a.diff.failSsim, "least structural similarity, 1 if equal");
    diff.add_option("--fail-flip", a.diff.failFlip, "largest mean FLIP, 0 if equal, at most 1");
    diff.add_option("--pixels-per-degree", a.diff.pixelsPerDegree,
                    "of the screen that FLIP assumes, 1 to 1000")
        ->capture_default_str();
    addRepeated(diff, "--fail-share", a.diff.failShares,
                "STEP=SHARE: largest share of pixels beyond STEP/255; steps 1, 4, 16");
    diff.add_flag("--json", a.diff.json, "JSON on stdout");
    return &diff;
}

void fillOptions(Arguments& a, bool hasFov) {
    auto& o = a.render.options;
    o.scene = a.scene;
    o.device = a.device;
    o.cache = !a.noCache;
    parseSize(a.size, o);
    parseSettings(a.settings, o);
    if (!a.eye.empty()) o.eye = a.eye;
    if (!a.target.empty()) o.target = a.target;
    if (hasFov) o.fovDegrees = a.fov;
}

int runCompareWith(Arguments& a, int argc, char** argv) {
    for (const auto& [key, value] : a.render.options.settings) {
        const auto technique = key.substr(0, key.find('.'));
        requireUsage(
            std::any_of(a.compare.techniques.begin(), a.compare.techniques.end(),
                        [&](const auto& t) { return t.substr(0, t.find(':')) == technique; }),
            "--set '{}={}' is for {}, which --techniques does not list", key, value, technique);
    }
    a.compare.options = a.render.options;
    a.compare.command = "penumbra";
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const bool plain = word.find_first_of(" ;'\"$&|<>()*?#") == std::string::npos;
        a.compare.command += plain ? " " + word : " '" + word + "'";
    }
    return runCompare(a.compare);
}

/// Names a word that is no command, which CLI11 does not.
void requireCommand(const std::string& word) {
    const std::vector<std::string> commands{"render", "compare", "diff",
                                            "info",   "devices", "techniques"};
    requireUsage(!word.empty(), "no command is given; allowed: {}", fmt::join(commands, ", "));
    requireUsage(
        word[0] == '-' || std::find(commands.begin(), commands.end(), word) != commands.end(),
        "'{}' is not a command; allowed: {}", word, fmt::join(commands, ", "));
}

}  // namespace

int runCommandLine(int argc, char** argv) {
    requireCommand(argc > 1 ? argv[1] : "");
    CLI::App app("penumbra: accurate soft shadows for animated glTF scenes, on any OpenCL device");
    app.set_version_flag("--version", version());
    app.require_subcommand(1);
    Arguments a;
    const auto* render = addRender(app, a);
    const auto* compare = addCompare(app, a);
    const auto* diff = addDiff(app, a);
    auto* info = app.add_subcommand("info", "What is in a scene, and what of it is used");
    addScene(*info, a);
    info->add_flag("--json", a.json, "JSON on stdout");
    auto* devices =
        app.add_subcommand("devices", "Every OpenCL device, which one is chosen and why");
    devices->add_option("--device", a.device, "as for render");
    devices->add_flag("--json", a.json, "JSON on stdout");
    devices->add_flag("-v,--verbose", a.verbose, "all that is known of each");
    auto* techniques = app.add_subcommand("techniques", "Every technique and setting");
    techniques->add_flag("--json", a.json, "JSON on stdout");
    std::vector<std::string> arguments(argv + 1, argv + argc);
    if (!arguments.empty() && arguments[0] == "render") arguments = withConfig(arguments, *render);
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
    try {
        app.parse(arguments);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        std::string message = error.what();
        std::replace(message.begin(), message.end(), '\n', ' ');
        throw Error(message + "; see penumbra " +
                        (argc > 1 && argv[1][0] != '-' ? std::string(argv[1]) + " " : "") +
                        "--help",
                    ExitCode::usage);
    }
    if (render->parsed()) {
        fillOptions(a, render->count("--fov") > 0);
        requireOwnSettings(a.render.options);
        return runRender(a.render);
    }
    if (compare->parsed()) {
        fillOptions(a, compare->count("--fov") > 0);
        return runCompareWith(a, argc, argv);
    }
    if (diff->parsed()) return runDiff(a.diff);
    if (info->parsed()) return runInfo(a.scene, a.json);
    if (devices->parsed()) return runDevices(a.device, a.json, a.verbose);
    return runTechniques(a.json);
}

}  // namespace penumbra::app
