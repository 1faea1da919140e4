// SPDX-License-Identifier: MIT
// SVG charts of the report.
#include <algorithm>
#include <cmath>

#include "host/report/page_parts.h"
#include "runtime/error.h"

namespace penumbra::report {
namespace {

constexpr double kWidth = 520, kHeight = 330, kLeft = 66, kRight = 16, kTop = 30, kBottom = 48;

/// An axis from values to pixels.
class Axis {
  public:
    Axis(std::vector<double> values, bool logarithmic, double from, double to)
        : log_(logarithmic), from_(from), to_(to) {
        if (log_) std::erase_if(values, [](double v) { return v <= 0; });
        low_ = values.empty() ? 0 : *std::min_element(values.begin(), values.end());
        high_ = values.empty() ? 1 : *std::max_element(values.begin(), values.end());
        if (log_) {
            low_ = std::pow(10, std::floor(std::log10(low_ > 0 ? low_ : 0.1) * 3) / 3);
            high_ = std::pow(10, std::ceil(std::log10(high_ > 0 ? high_ : 1) * 3) / 3);
            if (high_ <= low_) high_ = 10 * low_;
        } else {
            low_ = std::min(low_, 0.0);
            if (high_ <= low_) high_ = low_ + 1;
            high_ += 0.05 * (high_ - low_);
        }
    }
    /// A linear axis that spans the values alone.
    static Axis tight(const std::vector<double>& values, double from, double to) {
        Axis axis(values, false, from, to);
        if (!values.empty()) axis.low_ = *std::min_element(values.begin(), values.end());
        axis.high_ = values.empty() ? 1 : *std::max_element(values.begin(), values.end());
        if (axis.high_ <= axis.low_) axis.high_ = axis.low_ + 1;
        return axis;
    }
    double at(double value) const {
        const double t = log_ ? std::log(std::max(value, low_) / low_) / std::log(high_ / low_)
                              : (value - low_) / (high_ - low_);
        return from_ + t * (to_ - from_);
    }
    std::vector<double> ticks(bool whole = false) const {
        std::vector<double> values;
        if (log_) {
            for (double decade = std::pow(10, std::floor(std::log10(low_))); decade <= high_;
                 decade *= 10)
                for (const double step : {1.0, 2.0, 5.0})
                    if (decade * step >= low_ * 0.999 && decade * step <= high_ * 1.001)
                        values.push_back(decade * step);
            if (values.size() > 8)
                std::erase_if(values, [](double v) {
                    return std::abs(std::log10(v) - std::round(std::log10(v))) > 1e-6;
                });
            return values;
        }
        const double raw = (high_ - low_) / 5, power = std::pow(10, std::floor(std::log10(raw)));
        double step = power * (raw / power < 1.5   ? 1
                               : raw / power < 3.5 ? 2
                               : raw / power < 7.5 ? 5
                                                   : 10);
        if (whole) step = std::max(std::ceil(step), 1.0);
        for (double v = std::ceil(low_ / step) * step; v <= high_ * (1 + 1e-9); v += step)
            values.push_back(std::abs(v) < step / 1e6 ? 0 : v);
        return values;
    }

  private:
    bool log_;
    double from_, to_, low_ = 0, high_ = 1;
};

std::string text(double x, double y, const char* anchor, const std::string& words,
                 const std::string& more = "") {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>", x, y,
                       anchor, more, escaped(words));
}

std::string colour(std::size_t index) {
    return fmt::format("var(--c{})", index % 8);
}

std::string frame(const Axis& x, const Axis& y, const ChartLabels& labels) {
    std::string svg = text(kLeft, 16, "start", labels.title, " class=\"name\"");
    for (const double tick : x.ticks(labels.wholeX))
        svg += fmt::format("<path class=\"axis\" d=\"M{:.1f} {}V{}\"/>", x.at(tick), kTop,
                           kHeight - kBottom) +
               text(x.at(tick), kHeight - kBottom + 16, "middle", fmt::format("{:.4g}", tick));
    for (const double tick : y.ticks())
        svg += fmt::format("<path class=\"axis\" d=\"M{} {:.1f}H{}\"/>", kLeft, y.at(tick),
                           kWidth - kRight) +
               text(kLeft - 6, y.at(tick) + 4, "end", fmt::format("{:.3g}", tick));
    svg += text((kLeft + kWidth - kRight) / 2, kHeight - 12, "middle", labels.x);
    svg += fmt::format(
        "<text transform=\"translate(14 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
        (kTop + kHeight - kBottom) / 2, escaped(labels.y));
    return svg;
}

/// What no other point beats in both: from the cheapest to the most accurate.
std::string paretoFront(const std::vector<Series>& series, const Axis& x, const Axis& y) {
    std::vector<std::pair<double, double>> points;
    for (const auto& s : series)
        if (!s.x.empty()) points.emplace_back(s.x[0], s.y[0]);
    std::sort(points.begin(), points.end());
    std::string path;
    double best = 1e300;
    for (const auto& [px, py] : points) {
        if (py >= best) continue;
        best = py;
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x.at(px), y.at(py));
    }
    return fmt::format(
        "<path d=\"{}\" fill=\"none\" stroke=\"var(--faint)\" stroke-dasharray=\"4 4\"/>", path);
}

std::string pointMarks(const std::vector<Series>& series, const Axis& x, const Axis& y) {
    std::string svg = paretoFront(series, x, y);
    for (std::size_t i = 0; i < series.size(); ++i) {
        if (series[i].x.empty()) continue;
        const double px = x.at(series[i].x[0]), py = y.at(series[i].y[0]);
        const bool right = px > kWidth - 120;
        svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"{}\"/>", px, py,
                           colour(i)) +
               text(px + (right ? -9 : 9), py + (i % 2 ? 15 : -6), right ? "end" : "start",
                    series[i].name, fmt::format(" style=\"fill:{}\"", colour(i)));
    }
    return svg;
}

std::string lines(const std::vector<Series>& series, const Axis& x, const Axis& y) {
    std::string svg;
    for (std::size_t i = 0; i < series.size(); ++i) {
        std::string path, dots;
        for (std::size_t k = 0; k < series[i].x.size(); ++k) {
            const double px = x.at(series[i].x[k]), py = y.at(series[i].y[k]);
            path += fmt::format("{}{:.1f} {:.1f}", k ? "L" : "M", px, py);
            if (series[i].x.size() <= 12)
                dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>", px,
                                    py, colour(i));
        }
        svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>{}",
                           path, colour(i), dots);
        svg += text(kWidth - kRight - 4, kTop + 12 + 15 * static_cast<double>(i), "end",
                    series[i].name, fmt::format(" style=\"fill:{}\"", colour(i)));
    }
    return svg;
}

}  // namespace

std::string chart(const std::vector<Series>& series, const ChartLabels& labels) {
    std::vector<double> xs, ys;
    for (const auto& s : series) {
        xs.insert(xs.end(), s.x.begin(), s.x.end());
        ys.insert(ys.end(), s.y.begin(), s.y.end());
    }
    const Axis x = labels.logX || labels.points ? Axis(xs, labels.logX, kLeft, kWidth - kRight)
                                                : Axis::tight(xs, kLeft, kWidth - kRight);
    const Axis y(ys, labels.logY, kHeight - kBottom, kTop);
    return fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">{}{}</svg>",
                       kWidth, kHeight, escaped(labels.title), frame(x, y, labels),
                       labels.points ? pointMarks(series, x, y) : lines(series, x, y));
}

}  // namespace penumbra::report
