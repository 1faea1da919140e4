// SPDX-License-Identifier: MIT
// The report's page, from top to bottom.
#include <algorithm>
#include <filesystem>

#include "host/report/page_parts.h"
#include "runtime/error.h"
#include "runtime/whole_file.h"

namespace penumbra::report {
namespace {

constexpr double kFullError = 0.5;  // of visibility: the strongest colour of the maps

std::string heading(const Comparison& c) {
    const auto scene = c.options.base.scene.empty() ? "the built-in scene" : c.options.base.scene;
    std::string html = fmt::format("<h1>Soft shadows of {}</h1>", escaped(scene));
    html += fmt::format(
        "<p>{} x {} pixels, {} frame{}, {} light samples ({}) where a technique has no own; "
        "reference: "
        "{}{}. Device: {} ({}). penumbra {}.</p>",
        c.width, c.height, c.options.frames.size(), c.options.frames.size() == 1 ? "" : "s",
        escaped(c.options.base.lightSamples), escaped(c.options.base.lightPattern),
        escaped(c.options.reference),
        c.reference.settings.empty()
            ? ""
            : " with " + escaped(c.reference.settings.at("lightSamples")) + " samples",
        escaped(c.device), escaped(c.driver), version());
    return html + fmt::format("<pre>{}</pre>", escaped(c.options.command));
}

/// Index of the smallest value; what cannot be compared is negative.
std::size_t bestOf(const std::vector<double>& values) {
    std::size_t best = values.size();
    for (std::size_t i = 0; i < values.size(); ++i)
        if (values[i] >= 0 && (best == values.size() || values[i] < values[best])) best = i;
    return best;
}

std::vector<std::string> ownStages(const Comparison& c) {
    std::vector<std::string> stages;
    for (const auto& result : c.results)
        for (const auto& stage : result.stageOrder)
            if (std::find(stages.begin(), stages.end(), stage) == stages.end())
                stages.push_back(stage);
    std::erase_if(stages, [](const auto& s) { return s == "other"; });
    return stages;
}

std::string cell(bool best, const std::string& value) {
    return fmt::format("<td{}>{}</td>", best ? " class=\"best\"" : "", value);
}

std::string orDash(const std::optional<double>& value, int digits) {
    return value ? fmt::format("{:.{}f}", *value, digits) : std::string("-");
}

std::string nameCell(std::size_t index, const ContenderResult& result) {
    return fmt::format("<tr><td style=\"color:var(--c{})\"><b>{}</b></td>", index % 8,
                       escaped(result.contender.label));
}

std::string summary(const Comparison& c) {
    const bool several = c.options.frames.size() > 1;
    std::string html =
        "<h2>Cost and error</h2><div class=\"scroll\"><table><thead><tr><th>technique</th>"
        "<th>shadows<br>ms</th><th>frame<br>ms</th><th>faster<br>than mvr</th><th>RMSE</th>"
        "<th>FLIP</th><th>max</th><th>beyond<br>4/255</th><th>same<br>samples</th>"
        "<th>picture RMSE<br>of 255</th><th>picture<br>FLIP</th>";
    html += several ? "<th>flicker</th></tr></thead><tbody>" : "</tr></thead><tbody>";
    std::vector<double> times, errors, flips;
    for (const auto& r : c.results) {
        times.push_back(r.ms > 0 ? r.ms : -1);
        errors.push_back(r.error.rmse);
        flips.push_back(r.error.flip);
    }
    for (std::size_t i = 0; i < c.results.size(); ++i) {
        const auto& r = c.results[i];
        html += nameCell(i, r) + cell(i == bestOf(times), fmt::format("{:.2f}", r.ms));
        html += fmt::format("<td>{:.1f}</td>", r.totalMs);
        html += r.fasterThanMvr ? fmt::format("<td>{:.2f} x</td>", *r.fasterThanMvr)
                                : std::string("<td><small>-</small></td>");
        html += cell(i == bestOf(errors), fmt::format("{:.4f}", r.error.rmse));
        html += cell(i == bestOf(flips), fmt::format("{:.4f}", r.error.flip));
        html +=
            fmt::format("<td>{:.3f}</td><td>{:.2f} %</td><td>{}</td><td>{:.2f}</td><td>{:.4f}</td>",
                        r.error.maximum, 100 * r.error.share4, orDash(r.sameSamples, 4),
                        r.error.frameRmse255, r.error.frameFlip);
        html +=
            several ? fmt::format("<td>{}</td></tr>", orDash(r.flicker, 5)) : std::string("</tr>");
    }
    const bool ofVisibility = c.results.front().ofVisibility;
    html += fmt::format(
        "</tbody></table></div><p>RMSE, FLIP, max and the share beyond 4/255 are {}; <i>same "
        "samples</i> is the RMSE of visibility against rays to the very samples that the technique "
        "uses: its error without that of the sampling; <i>picture</i> is the tone-mapped frame. "
        "<i>Shadows</i> are all stages but the camera's and shading. The best of a column is "
        "marked.",
        ofVisibility ? "of visibility against the reference, over the pixels that a light can reach"
                     : "of the tone-mapped picture, background included, since the reference holds "
                       "no visibility");
    if (several)
        html += fmt::format(
            " Flicker is the mean change of visibility from frame to frame on receivers that rest; "
            "the reference has {}. It needs a rendered reference, which knows what rests.",
            orDash(c.reference.flicker, 5));
    return html + "</p>";
}

std::string stageTable(const Comparison& c) {
    const auto stages = ownStages(c);
    std::string html =
        "<h3>Milliseconds of each stage</h3><div "
        "class=\"scroll\"><table><thead><tr><th>technique</th>";
    for (const auto& stage : stages) html += fmt::format("<th>{}</th>", escaped(stage));
    html += "</tr></thead><tbody>";
    for (std::size_t i = 0; i < c.results.size(); ++i) {
        html += nameCell(i, c.results[i]);
        for (const auto& stage : stages) {
            const auto found = c.results[i].stageMs.find(stage);
            html += found == c.results[i].stageMs.end()
                        ? "<td><small>-</small></td>"
                        : fmt::format("<td>{:.2f}</td>", found->second);
        }
        html += "</tr>";
    }
    return html + "</tbody></table></div>";
}

std::string slider(const std::string& left, const std::string& leftName, const std::string& right,
                   const std::string& rightName) {
    return fmt::format(
        "<div class=\"slider\"><img src=\"{2}\" alt=\"{3}\"><img class=\"over\" src=\"{0}\" "
        "alt=\"{1}\">"
        "<input type=\"range\" min=\"0\" max=\"100\" step=\"0.1\" value=\"50\" aria-label=\"{1} "
        "against {3}\">"
        "<div class=\"bar\"></div><span class=\"left\">{1}</span><span "
        "class=\"right\">{3}</span></div>",
        left, escaped(leftName), right, escaped(rightName));
}

std::string pictures(const Comparison& c) {
    const std::string truth = pictureUri(c.reference.shown.frame, c.width, c.height);
    std::string html = fmt::format(
        "<h2>Beside the reference</h2><p>Frame {}. Move over a picture, or use the arrow keys: the "
        "technique is left of "
        "the seam, the reference right of it. Below it, where the technique errs.</p>",
        c.shownFrame);
    html += fmt::format(
        "<div class=\"legend\">too dark<i style=\"background:{}\"></i>too light (full colour: {} "
        "of visibility)</div>"
        "<div class=\"legend\">FLIP 0<i style=\"background:{}\"></i>1</div>",
        errorGradient(), kFullError, flipGradient());
    for (const auto& r : c.results) {
        html += fmt::format("<h3>{}</h3><figure>{}</figure>", escaped(r.contender.label),
                            slider(pictureUri(r.shown.frame, c.width, c.height), r.contender.label,
                                   truth, "reference"));
        html += "<div class=\"pair\">";
        if (r.shown.visibility.size() == c.reference.shown.visibility.size())
            html += fmt::format(
                "<figure><img alt=\"error of visibility of {0}\" "
                "src=\"{1}\"><figcaption>visibility: mean "
                "difference {2:.4f}, RMSE {3:.4f}</figcaption></figure>",
                escaped(r.contender.label),
                pictureUri(errorColours(c.reference.shown, r.shown, kFullError), c.width, c.height),
                r.error.mean, r.error.rmse);
        html += fmt::format(
            "<figure><img alt=\"FLIP of {0}\" src=\"{1}\"><figcaption>FLIP of the frame: mean "
            "{2:.4f}</figcaption></figure></div>",
            escaped(r.contender.label), pictureUri(flipColours(r.shown.flip), c.width, c.height),
            r.error.frameFlip);
    }
    return html;
}

std::string insets(const Comparison& c) {
    const auto squares = findInsets(c, 4);
    if (squares.empty()) return "";
    std::string html =
        "<h2>Where they differ most</h2><p>The parts of the frame in which the techniques' errors "
        "are farthest apart.</p>";
    html +=
        fmt::format("<div class=\"where\"><img alt=\"reference with the parts marked\" src=\"{}\">",
                    pictureUri(c.reference.shown.frame, c.width, c.height));
    for (std::size_t i = 0; i < squares.size(); ++i)
        html += fmt::format(
            "<i style=\"left:{:.2f}%;top:{:.2f}%;width:{:.2f}%;height:{:.2f}%\">{}</i>",
            100.0 * squares[i].x / c.width, 100.0 * squares[i].y / c.height,
            100.0 * squares[i].size / c.width, 100.0 * squares[i].size / c.height, i + 1);
    html += "</div>";
    for (std::size_t i = 0; i < squares.size(); ++i) {
        html += fmt::format("<h3>Part {}</h3><div class=\"insets\" style=\"--columns:{}\">", i + 1,
                            c.results.size() + 1);
        const auto one = [&](const Pictures& shown, const std::string& name) {
            html += fmt::format(
                "<figure><img alt=\"{0}, part {1}\" "
                "src=\"{2}\"><figcaption>{0}</figcaption></figure>",
                escaped(name), i + 1,
                pictureUri(cropped(shown, squares[i]), squares[i].size, squares[i].size));
        };
        one(c.reference.shown, "reference");
        for (const auto& r : c.results) one(r.shown, r.contender.label);
        html += "</div>";
    }
    return html;
}

std::string charts(const Comparison& c) {
    std::vector<Series> scatter;
    for (const auto& r : c.results) scatter.push_back({r.contender.label, {r.ms}, {r.error.rmse}});
    std::string html = "<h2>Error against time</h2><div class=\"charts\">";
    html += chart(scatter, {"Error against time, with the Pareto front", "ms of shadows",
                            "RMSE of visibility", true, true, false, true});
    if (c.options.frames.size() > 1) {
        std::vector<Series> errors, flicker;
        for (const auto& r : c.results) {
            Series error{r.contender.label, {}, {}}, change = error;
            for (const auto& f : r.frames) {
                error.x.push_back(f.number);
                error.y.push_back(f.reference.rmse);
                if (!f.flicker) continue;  // the first frame, and what a file does not tell
                change.x.push_back(f.number);
                change.y.push_back(*f.flicker);
            }
            errors.push_back(error);
            flicker.push_back(change);
        }
        html +=
            chart(errors, {"Error over time", "frame", "RMSE of visibility", false, false, true});
        if (c.reference.flicker)
            html += chart(flicker, {"Flicker on resting receivers", "frame",
                                    "mean change of visibility", false, false, true});
    }
    return html + "</div>";
}

std::string sweep(const Comparison& c) {
    if (c.sweep.empty()) return "";
    std::vector<Series> errors, times;
    for (const auto& r : c.sweep) {
        auto at = std::find_if(errors.begin(), errors.end(),
                               [&](const Series& s) { return s.name == r.contender.label; });
        if (at == errors.end()) {
            errors.push_back({r.contender.label, {}, {}});
            times.push_back({r.contender.label, {}, {}});
            at = errors.end() - 1;
        }
        auto& time = times[static_cast<std::size_t>(at - errors.begin())];
        at->x.push_back(*r.sweepValue);
        at->y.push_back(r.error.rmse);
        time.x.push_back(*r.sweepValue);
        time.y.push_back(r.ms);
    }
    const std::string key = c.options.sweep.substr(0, c.options.sweep.find('='));
    return fmt::format(
        "<h2>Sweep of {}</h2><div class=\"charts\">{}{}</div>", escaped(key),
        chart(errors, {"Error against " + key, key, "RMSE of visibility", true, true}),
        chart(times, {"Time against " + key, key, "ms of shadows", true, true}));
}

std::string details(const Comparison& c) {
    std::string html =
        "<h2>What made this page</h2><div "
        "class=\"scroll\"><table><thead><tr><th>technique</th><th>points</th>"
        "<th>triangles<br>a "
        "map</th><th>maps<br>MB</th><th>device<br>MB</th><th>files</th></tr></thead><tbody>";
    for (const auto& r : c.results) {
        std::string files;
        for (std::size_t i = 0; i < r.files.size() && i < 2; ++i)
            files += fmt::format("<a href=\"{0}\">{0}</a> ", escaped(r.files[i]));
        if (r.files.size() > 2) files += fmt::format("and {} more", r.files.size() - 2);
        html += fmt::format(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.1f}</td><td>{:.1f}</td><td>{}</td></tr>",
            escaped(r.contender.label), r.points, r.mapTriangles,
            static_cast<double>(r.mapBytes) / 1048576.0, static_cast<double>(r.bytes) / 1048576.0,
            files);
    }
    html += "</tbody></table></div>";
    for (const auto& r : c.results) {
        std::string settings;
        for (const auto& [key, value] : r.settings)
            if (key.rfind(r.contender.options.technique + ".", 0) == 0)
                settings += fmt::format("{}{}={}", settings.empty() ? "" : ", ",
                                        key.substr(key.find('.') + 1), value);
        if (!settings.empty())
            html += fmt::format("<p class=\"facts\"><b>{}</b>: {}</p>", escaped(r.contender.label),
                                escaped(settings));
    }
    for (const auto& warning : c.warnings)
        html += fmt::format("<p class=\"facts\">Note: {}</p>", escaped(warning));
    return html +
           "<p class=\"facts\">All figures are in results.json beside this page. FLIP: Andersson "
           "et al. 2020, 67 "
           "pixels per degree.</p>";
}

void writeText(const std::filesystem::path& path, const std::string& text) {
    runtime::WholeFile file(path.string());
    file.write(text.data(), text.size());
    file.commit();
}

}  // namespace

std::string reportPage(const Comparison& c) {
    return fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width, initial-scale=1\"><title>penumbra: soft shadows "
        "compared</title>"
        "<link rel=\"icon\" "
        "href=\"data:,\"><style>{}</style></head><body>\n{}{}{}{}{}{}{}\n<script>{}</script></"
        "body></html>\n",
        kPageStyle, heading(c), summary(c) + stageTable(c), charts(c), sweep(c), pictures(c),
        insets(c), details(c), kPageScript);
}

void writeReport(const Comparison& comparison) {
    const std::filesystem::path folder(comparison.options.folder);
    writeText(folder / "results.json", resultsJson(comparison));
    writeText(folder / "index.html", reportPage(comparison));
}

}  // namespace penumbra::report
