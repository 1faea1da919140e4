// SPDX-License-Identifier: MIT
// What the report's page is put together from: escaped text, pictures in the page itself, charts.
#pragma once
#include <string>
#include <vector>

#include "host/report/comparison.h"

namespace penumbra::report {

extern const char* const kPageStyle;   ///< host/report/page/style.css
extern const char* const kPageScript;  ///< host/report/page/script.js

/// Text that may stand in HTML, in attributes too.
std::string escaped(const std::string& text);

/// "data:image/png;base64,..." of sRGB bytes [height, width, 3].
std::string pictureUri(const std::vector<std::uint8_t>& rgb, int width, int height);

/// Where visibility is too dark (red) or too light (blue), `full` = strongest colour.
std::vector<std::uint8_t> errorColours(const Pictures& truth, const Pictures& frame, double full);
/// FLIP in [0, 1], black to white through red and yellow.
std::vector<std::uint8_t> flipColours(const metrics::Plane& flip);
/// CSS gradients of both scales.
std::string errorGradient();
std::string flipGradient();

/// A square part of the frame, pixels.
struct Inset {
    int x = 0, y = 0, size = 0;
};
/// The parts where the contenders' errors differ most from each other, apart from one another.
std::vector<Inset> findInsets(const Comparison& comparison, int count);
std::vector<std::uint8_t> cropped(const Pictures& frame, const Inset& inset);

struct Series {
    std::string name;
    std::vector<double> x, y;
};
struct ChartLabels {
    std::string title, x, y;
    bool logX = false, logY = false;
    bool wholeX = false;  ///< x counts something: no ticks between whole numbers
    bool points = false;  ///< a point each with its name, and the Pareto front; else lines
};
/// An SVG chart; colours are those of the style sheet, in the order of the series.
std::string chart(const std::vector<Series>& series, const ChartLabels& labels);

}  // namespace penumbra::report
