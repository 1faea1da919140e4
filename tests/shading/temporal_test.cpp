// SPDX-License-Identifier: MIT
// Averaging over a window of frames against its double-precision twin: noise as visibility, so that
// following a surface to a wrong pixel, or a frame too many, shows.
#include "host/shading/temporal.h"

#include <algorithm>
#include <bit>
#include <random>

#include "kernels/shared/gbuffer.h"
#include "kernels/shared/multi_view.h"
#include "tests/reference/gbuffer_run.h"
#include "tests/reference/temporal_ref.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

constexpr std::pair<int, int> kSizes[] = {{7, 5}, {33, 17}, {61, 37}};

struct Motion {
    double camera = 0;  ///< speed, to either side
    bool surfaces = false, orthographic = false;
};

/// A wall; before it a mesh of three layers, two of them 4 % of their depth apart, so that parallax
/// uncovers parts of the same object; a plate of its own; and one so near to the wall (0.5 %) that
/// only its name tells it apart.
/// `blended`: all but the wall are, and a fourth layer is 0.5 % off the first.
scene::Scene stage(bool blended) {
    SceneBuilder builder;
    builder.material().doubleSided = true;
    builder.addQuad({-8, -6, -2}, {16, 0, 0}, {0, 12, 0});
    std::vector<glm::vec3> corners;
    std::vector<std::uint32_t> indices;
    std::vector<float> layers{0.0F, -0.16F, -1.0F};
    if (blended) layers.push_back(-0.02F);
    for (const float z : layers)
        for (const glm::vec2 v : {glm::vec2(-1.5F, -1), glm::vec2(0.2F, -1), glm::vec2(0.2F, 1)}) {
            indices.push_back(static_cast<std::uint32_t>(corners.size()));
            corners.emplace_back(v.x - 2 * z, v.y - z, z);
        }
    builder.addMesh(corners, indices);
    builder.addQuad({0.3F, -0.6F, 0.8F}, {0.7F, 0, 0}, {0, 0.9F, 0.2F});
    builder.addQuad({-2.5F, 0.4F, -1.97F}, {2, 0, 0}, {0, 1.2F, 0});
    auto& scene = builder.scene();
    if (!blended) return scene;
    scene.materials.push_back(scene.materials[0]);
    scene.materials[1].alphaMode = scene::AlphaMode::blend;
    scene.materials[1].baseColor.w = 0.5F;
    for (std::size_t i = 1; i < scene.meshes.size(); ++i)
        scene.meshes[i].primitives[0].material = 1;
    return scene;
}

/// Drives geometry, G-buffer and averaging through frames, and keeps what the twin needs.
class Sequence {
  public:
    Sequence(int width, int height, int window, Motion motion, int channels, bool blended = false)
        : width_(width),
          height_(height),
          window_(window),
          motion_(motion),
          channels_(channels),
          scene_(stage(blended)),
          geometry_(program("frame"), scene_, glm::dvec3(0)),
          pass_(program("frame"), width, height),
          temporal_(program("frame"), width, height, window) {}

    /// Renders a frame `times` times, as if its lists had been too short, and compares the last.
    /// Returns how many frames each pixel's mean is of.
    std::vector<int> next(int times = 1) {
        const auto camera = cameraAt(number_);
        move(number_++);
        pass_.run(geometry_.run(scene::poseAt(scene_, {}, 0)), camera, glm::dvec3(0));
        while (pass_.grew()) pass_.run(geometry_.mesh(), camera, glm::dvec3(0));
        frames_.push_back(frameOf(camera));
        for (int i = 0; i < times; ++i) {
            if (i > 0) temporal_.undo();
            upload(frames_.back());
            temporal_.run(pass_.result(), 0, visibility_);
        }
        temporal_.endFrame(pass_.result(), camera, glm::dvec3(0));
        return compare();
    }
    void reset() {
        temporal_.reset();
        frames_.clear();
    }

  private:
    scene::CameraFrame cameraAt(int number) const {
        const double t = 0.13 * motion_.camera * number;
        auto camera = perspectiveCamera({0.9 * t, 0.3 - 0.4 * t, 4 - 0.5 * t}, {0.2 * t, 0, 0}, 45);
        camera.orthographic = motion_.orthographic;
        camera.xmag = 2.2, camera.ymag = 1.6;
        camera.nearMetres = 0.1, camera.farMetres = 20;
        return camera;
    }
    void move(int number) {
        const double t = motion_.surfaces ? 0.11 * number : 0;
        scene_.nodes[1].matrix[3] = {-t, 0.5 * t, 0.3 * t, 1};
        scene_.nodes[2].matrix[3] = {0.8 * t, 0.2 * t, -0.4 * t, 1};
        scene_.nodes[3].matrix[3] = {2 * t, -t, 0, 1};
    }
    TemporalFrame frameOf(const scene::CameraFrame& camera) {
        const auto stride = static_cast<std::size_t>(pass_.result().planeStride);
        const auto planes = pass_.result().planes.download();
        const auto at = [&](int plane, std::size_t i) {
            return planes[static_cast<std::size_t>(plane) * stride + i];
        };
        TemporalFrame frame;
        frame.width = width_, frame.height = height_;
        frame.camera = camera;
        std::uniform_real_distribution<float> unit(0, 1);
        const auto pixels = static_cast<std::size_t>(width_ * height_);
        for (std::size_t i = 0; i < pixels; ++i) frame.owner.push_back(i);
        frame.lists.resize(pixels);
        if (const auto* lists = pass_.result().blended) {
            const auto ends = lists->ends.download(), owners = lists->owners.download();
            for (std::size_t f = 0; f < ends[pixels - 1]; ++f) {
                frame.lists[owners[f]].push_back(pixels + f);
                frame.owner.push_back(owners[f]);
            }
        }
        for (std::size_t i = 0; i < frame.owner.size(); ++i) {
            frame.object.push_back(std::bit_cast<std::uint32_t>(at(GB_OBJECT, i)));
            frame.depth.push_back(at(GB_DEPTH, i));
            frame.previous.emplace_back(at(GB_PREVIOUS, i), at(GB_PREVIOUS + 1, i),
                                        at(GB_PREVIOUS + 2, i));
            frame.tested.push_back(frame.object.back() != 0 && random_() % 16 != 0);
            frame.visibility.emplace_back(unit(random_), unit(random_), unit(random_));
        }
        return frame;
    }
    void upload(const TemporalFrame& frame) {
        const auto stride = static_cast<std::size_t>(pass_.result().planeStride);
        std::vector<float> planes(static_cast<std::size_t>(channels_) * stride, 1.0F);
        std::vector<std::uint32_t> states(stride, STATE_MASKED);
        const std::uint32_t others[] = {STATE_MASKED, STATE_LIT, STATE_OUTSIDE};
        for (std::size_t i = 0; i < frame.tested.size(); ++i) {
            states[i] = frame.tested[i] ? STATE_TESTED : others[i % 3];
            for (int c = 0; c < channels_; ++c)
                planes[static_cast<std::size_t>(c) * stride + i] =
                    static_cast<float>(frame.visibility[i][c]);
        }
        visibility_.channels = channels_;
        visibility_.planes = runtime::Buffer<float>(device(), "visibility", planes);
        visibility_.state = runtime::Buffer<std::uint32_t>(device(), "states", states);
    }
    std::vector<int> compare() {
        const auto stride = static_cast<std::size_t>(pass_.result().planeStride);
        const auto planes = visibility_.planes.download();
        std::vector<int> counts;
        int wrong = 0, doubtful = 0;
        for (std::size_t i = 0; i < frames_.back().tested.size(); ++i) {
            const auto mean = temporalMean(frames_, window_, i);
            counts.push_back(mean.frames);
            doubtful += mean.doubtful;
            if (mean.doubtful) continue;
            for (int c = 0; c < channels_; ++c)
                // Sums of up to 5 numbers below 1: a few roundings of 6e-8; noise that is not the
                // surface's is off by 0.1 and more
                wrong += std::abs(planes[static_cast<std::size_t>(c) * stride + i] -
                                  mean.visibility[c]) > 1e-6;
        }
        EXPECT_EQ(wrong, 0) << "frame " << number_ - 1 << ", " << width_ << " x " << height_;
        // Of 1 in 500 a step ends within 1/1000 pixel of a border; several steps make a mean
        EXPECT_LE(doubtful, static_cast<int>(counts.size()) / 30 + 1);
        return counts;
    }

    int width_, height_, window_;
    Motion motion_;
    int channels_;
    scene::Scene scene_;
    geometry::Geometry geometry_;
    gbuffer::GBufferPass pass_;
    shading::Temporal temporal_;
    visibility::Visibility visibility_;
    std::mt19937 random_{1};
    int number_ = 0;
    std::vector<TemporalFrame> frames_;
};

std::size_t countOf(const std::vector<int>& counts, int frames) {
    return static_cast<std::size_t>(std::count(counts.begin(), counts.end(), frames));
}

TEST(Temporal, WindowsGrowToTheirLengthAndThenSlide) {
    for (const auto& [width, height] : kSizes)
        for (const int channels : {1, 3}) {
            Sequence sequence(width, height, 4, {}, channels);
            for (int frame = 0; frame < 7; ++frame) {
                const auto counts = sequence.next();
                EXPECT_EQ(*std::max_element(counts.begin(), counts.end()), std::min(frame + 1, 4));
            }
        }
}

TEST(Temporal, MovingCamerasFollowStillSurfaces) {
    for (const double speed : {-1.0, 1.0, 3.0})
        for (const auto& [width, height] : kSizes) {
            Sequence sequence(width, height, 5, {speed, false, false}, 1);
            std::vector<int> counts;
            for (int frame = 0; frame < 7; ++frame) counts = sequence.next();
            if (width < 33) continue;
            // What just came into view is alone, what is seen long has the whole window
            EXPECT_GT(countOf(counts, 1), 20U);
            EXPECT_GT(countOf(counts, 5), 100U);
        }
}

TEST(Temporal, MovingSurfacesAreFollowedByAStillCamera) {
    for (const auto& [width, height] : kSizes) {
        Sequence sequence(width, height, 3, {0, true, false}, 3);
        for (int frame = 0; frame < 6; ++frame) sequence.next();
    }
}

TEST(Temporal, CameraAndSurfacesMayMoveAtOnce) {
    for (const bool orthographic : {false, true})
        for (const auto& [width, height] : kSizes) {
            Sequence sequence(width, height, 4, {-1, true, orthographic}, 1);
            std::vector<int> counts;
            for (int frame = 0; frame < 6; ++frame) counts = sequence.next();
            if (width < 33) continue;
            for (const int frames : {1, 2, 3, 4}) EXPECT_GT(countOf(counts, frames), 3U) << frames;
        }
}

TEST(Temporal, BlendedFragmentsAreFollowedFromListToList) {
    for (const bool orthographic : {false, true})
        for (const auto& [width, height] : kSizes) {
            Sequence sequence(width, height, 4, {-1, true, orthographic}, 3, true);
            std::vector<int> counts;
            for (int frame = 0; frame < 6; ++frame) counts = sequence.next();
            if (width < 33) continue;
            const std::vector<int> fragments(counts.begin() + width * height, counts.end());
            for (const int frames : {1, 4}) EXPECT_GT(countOf(fragments, frames), 10U) << frames;
        }
}

TEST(Temporal, AWindowOfOneFrameLeavesVisibilityAlone) {
    Sequence sequence(33, 17, 1, {1, true, false}, 1);
    for (int frame = 0; frame < 3; ++frame) sequence.next();
}

TEST(Temporal, RepeatedFramesCountOnceAndResetForgets) {
    Sequence sequence(33, 17, 3, {1, true, false}, 1);
    sequence.next();
    sequence.next(2);
    sequence.next(3);
    EXPECT_GT(countOf(sequence.next(), 3), 50U);
    sequence.reset();
    EXPECT_EQ(countOf(sequence.next(), 1), 33U * 17);
    sequence.next();
}

}  // namespace
}  // namespace penumbra::tests
