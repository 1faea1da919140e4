// SPDX-License-Identifier: MIT
// How far a frame of a comparison is from another.
#pragma once
#include "host/report/contender_run.h"

namespace penumbra::report {

/// The pixels that count: the reference's where it knows them, so that all contenders are measured
/// over the same; else the frame's own; all (empty) where neither knows.
std::vector<bool> pixelsThatCount(const SeenFrame& truth, const SeenFrame& frame);

/// Errors of a frame; `flipMap` receives the map of the tone-mapped frame unless it is null.
FrameError errorOf(const SeenFrame& truth, const SeenFrame& frame, const std::vector<bool>& mask,
                   metrics::Plane* flipMap);

/// Sums of errors over frames (maximum: the largest), and their means.
void add(FrameError& sum, const FrameError& e);
FrameError scaled(FrameError e, double factor);

/// Pixels that show the same point in both frames, to within 1e-5 of its coordinates.
std::vector<bool> restingPixels(const SeenFrame& last, const SeenFrame& now);

/// Mean change of visibility since the last frame over receivers that rest; none where that is not
/// known.
std::optional<double> flickerOf(const SeenFrame& last, const SeenFrame& now,
                                const std::vector<bool>& resting);

}  // namespace penumbra::report
