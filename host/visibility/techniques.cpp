// SPDX-License-Identifier: MIT
// The only list of techniques: a line here gives the CLI value, its settings, the shared test suite
// and the benchmark of whole frames.
#include "host/visibility/essm.h"
#include "host/visibility/mlsm.h"
#include "host/visibility/mvr.h"
#include "host/visibility/mvss.h"
#include "host/visibility/none.h"
#include "host/visibility/pcss.h"
#include "host/visibility/raster4d.h"
#include "host/visibility/raytrace.h"
#include "host/visibility/technique.h"
#include "host/visibility/vwss.h"

namespace penumbra::visibility {
namespace {

template <typename T>
std::unique_ptr<Technique> make(const TechniqueContext& context) {
    return std::make_unique<T>(context);
}

}  // namespace

const std::vector<TechniqueEntry>& techniques() {
    static const std::vector<TechniqueEntry> list = {
        {"vwss",
         "view-warped soft shadows: casters become points once, points become a depth map per "
         "sample",
         "[VWSS] 3",
         "bands of self-shadowing, slight bloat of shadows, leaks at grazing angles; holes in "
         "slanting faces (density=2 closes them); few large triangles make many points; partial "
         "opacity blocks a share of the samples",
         describeSettings<VwssSettings>, checkSettings<VwssSettings>, Vwss::plannedBytes,
         make<Vwss>},
        {"mvr", "multi-view rasterisation: every triangle into a depth map per sample",
         "[VWSS] 2.1, 4",
         "cost grows with triangles times samples; aliasing of the maps' texels; partial opacity "
         "blocks a share of the samples",
         describeSettings<MvrSettings>, checkSettings<MvrSettings>, Mvr::plannedBytes, make<Mvr>},
        {"mvss",
         "as NVIDIA's sample: a few small maps at Poisson-disk samples, one bilinear tap each",
         "[MVSS]",
         "bands of 28 edges in wide penumbrae; acne or detached shadows where the fixed bias does "
         "not suit the scene",
         describeSettings<MvssSettings>, checkSettings<MvssSettings>, Mvss::plannedBytes,
         make<Mvss>},
        {"pcss", "percentage-closer soft shadows: one map, blocker search, filter", "[VWSS] 4",
         "occluder fusion (blockers of several depths), thin parts, light leaking where the centre "
         "of the light sees no blocker",
         describeSettings<PcssSettings>, checkSettings<PcssSettings>, Pcss::plannedBytes,
         make<Pcss>},
        {"essm", "exponential soft shadow maps: one map of exponentials, filtered beforehand",
         "[MLSM] 2, 8",
         "occluder fusion, thin parts, light leaking behind near blockers, missing contact "
         "shadows, a "
         "grid of the pyramid's texels in wide penumbrae",
         describeSettings<EssmSettings>, checkSettings<EssmSettings>, Essm::plannedBytes,
         make<Essm>},
        {"mlsm",
         "filtered multi-layer shadow maps: all fragments before the light's centre, filtered "
         "beforehand, with opacity and colour",
         "[MLSM]",
         "what only other points of the light see casts no shadow; penumbrae that overlap add up "
         "(accumulateLookup=multiply where occluders lie behind one another); thin parts between "
         "texels; of closed meshes back faces cast the shadow, whose penumbra is that of their "
         "depth; single lit pixels at the foot of walls",
         describeSettings<MlsmSettings>, checkSettings<MlsmSettings>, Mlsm::plannedBytes,
         make<Mlsm>},
        {"raster4d",
         "exact: triangles and receivers meet in the light's grid and give a bit per light sample, "
         "a "
         "row of them at a time",
         "[4DR]",
         "none but the light samples' number, at most 64 x 64; cost grows with the light's size; "
         "partial opacity blocks a share of the samples",
         describeSettings<Raster4dSettings>, checkSettings<Raster4dSettings>,
         Raster4d::plannedBytes, make<Raster4d>},
        {"raytrace",
         "the reference: one ray per light sample and pixel, opacity and colour along it", "",
         "none but the light samples' number", describeSettings<RaytraceSettings>,
         checkSettings<RaytraceSettings>, Raytrace::plannedBytes, make<Raytrace>},
        {"none", "no shadows", "", "lights through everything", describeSettings<NoSettings>,
         checkSettings<NoSettings>, [](const TechniqueContext&) -> std::uint64_t { return 0; },
         make<None>},
    };
    return list;
}

const TechniqueEntry& findTechnique(const std::string& name) {
    std::string names;
    for (const auto& entry : techniques()) {
        if (entry.name == name) return entry;
        names += fmt::format("{}{}", names.empty() ? "" : ", ", entry.name);
    }
    throw Error(fmt::format("technique '{}' is unknown; allowed: {}", name, names),
                ExitCode::usage);
}

}  // namespace penumbra::visibility
