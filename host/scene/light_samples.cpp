// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "host/scene/light.h"
#include "host/scene/poisson_disk.h"
#include "runtime/error.h"

namespace penumbra::scene {
namespace {

constexpr int kMaxSamples = 4096;
constexpr double kPi = 3.14159265358979323846;

double radicalInverse(std::uint32_t bits) {
    double value = 0;
    for (double digit = 0.5; bits; bits >>= 1, digit *= 0.5)
        if (bits & 1) value += digit;
    return value;
}

/// Shirley and Chiu's concentric map from the square [-1, 1]^2 to the unit disk.
glm::dvec2 toDisk(const glm::dvec2& p) {
    if (p.x == 0 && p.y == 0) return p;
    const bool wide = std::abs(p.x) > std::abs(p.y);
    const double r = wide ? p.x : p.y;
    const double angle = wide ? kPi / 4 * (p.y / p.x) : kPi / 2 - kPi / 4 * (p.x / p.y);
    return {r * std::cos(angle), r * std::sin(angle)};
}

std::vector<glm::dvec2> hammersley(int count) {
    std::vector<glm::dvec2> points;
    points.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
        points.emplace_back(2 * (i + 0.5) / count - 1,
                            2 * (radicalInverse(static_cast<std::uint32_t>(i)) + 0.5 / count) - 1);
    return points;
}

std::vector<glm::dvec2> cells(const SampleChoice& choice, bool disk) {
    std::vector<glm::dvec2> points;
    std::uint32_t state = choice.seed * 2654435769U + 999U;
    const bool jitter = choice.pattern == Pattern::jittered;
    for (int row = 0; row < choice.rows; ++row)
        for (int column = 0; column < choice.columns; ++column) {
            const double dx = jitter ? uniform(state) : 0.5, dy = jitter ? uniform(state) : 0.5;
            const double cx = 2 * (column + 0.5) / choice.columns - 1;
            const double cy = 2 * (row + 0.5) / choice.rows - 1;
            if (disk && cx * cx + cy * cy > 1) continue;
            points.emplace_back(2 * (column + dx) / choice.columns - 1,
                                2 * (row + dy) / choice.rows - 1);
        }
    return points;
}

int parseInt(const std::string& text, const std::string& whole, const std::string& option) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    requireUsage(error == std::errc() && end == text.data() + text.size() && value > 0,
                 "{} '{}' is not a number of samples; allowed: N or MxN, 1 to {} in all", option,
                 whole, kMaxSamples);
    return value;
}

}  // namespace

SampleChoice parseSampleCount(const std::string& text, SampleChoice choice,
                              const std::string& option) {
    const auto cross = text.find('x');
    if (cross == std::string::npos) {
        choice.count = parseInt(text, text, option);
        choice.columns = choice.rows = 0;
    } else {
        choice.columns = parseInt(text.substr(0, cross), text, option);
        choice.rows = parseInt(text.substr(cross + 1), text, option);
        requireUsage(choice.columns <= kMaxSamples && choice.rows <= kMaxSamples,
                     "{} {} has more than {} samples", option, text, kMaxSamples);
        choice.count = choice.columns * choice.rows;
        requireUsage(choice.pattern != Pattern::poisson && choice.pattern != Pattern::random,
                     "{} {} is a grid, and --light-pattern poisson and random are "
                     "none; allowed: grid, jittered",
                     option, text);
        if (choice.pattern != Pattern::jittered) choice.pattern = Pattern::grid;
    }
    requireUsage(choice.count <= kMaxSamples, "{} {} is outside of 1 to {}", option, text,
                 kMaxSamples);
    return choice;
}

Pattern parsePattern(const std::string& text) {
    if (text == "hammersley") return Pattern::hammersley;
    if (text == "poisson") return Pattern::poisson;
    if (text == "grid") return Pattern::grid;
    if (text == "jittered") return Pattern::jittered;
    if (text == "random") return Pattern::random;
    throw Error(
        fmt::format(
            "--light-pattern '{}' is unknown; allowed: hammersley, poisson, grid, jittered, "
            "random",
            text),
        ExitCode::usage);
}

std::uint32_t parseSeed(const std::string& text, int frame) {
    if (text == "frame") return static_cast<std::uint32_t>(frame);
    std::uint32_t seed = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
    requireUsage(error == std::errc() && end == text.data() + text.size(),
                 "--seed '{}' is neither a whole number from 0 to {} nor 'frame'", text,
                 std::numeric_limits<std::uint32_t>::max());
    return seed;
}

std::vector<glm::dvec2> samplePattern(const SampleChoice& choice, bool disk) {
    if (choice.count == 1) return {{0, 0}};
    if (choice.pattern == Pattern::grid || choice.pattern == Pattern::jittered) {
        SampleChoice grid = choice;
        if (grid.columns == 0) {
            // The most square grid of exactly this many cells
            grid.rows = static_cast<int>(std::sqrt(static_cast<double>(choice.count)));
            while (choice.count % grid.rows != 0) --grid.rows;
            grid.columns = choice.count / grid.rows;
        }
        return cells(grid, disk);
    }
    if (choice.pattern == Pattern::poisson) return poissonDisk(choice.count, disk, choice.seed);
    auto points = hammersley(choice.count);
    if (disk)
        for (auto& p : points) p = toDisk(p);
    return points;
}

void placeSamples(SampleChoice choice, AreaLight& light) {
    if (light.isPoint()) choice.count = 1;
    light.samples.clear();
    if (choice.pattern == Pattern::random && !light.isPoint()) light.randomSeed = choice.seed;
    for (const auto& p : samplePattern(choice, light.disk))
        light.samples.emplace_back(p.x * light.width / 2, p.y * light.height / 2);
}

}  // namespace penumbra::scene
