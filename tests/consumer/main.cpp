// SPDX-License-Identifier: MIT
// Renders a frame through the installed library and checks that something is lit and something is
// not.
#include <penumbra/penumbra.h>

#include <algorithm>
#include <cstdio>
#include <exception>

int main() try {
    penumbra::RenderOptions options;
    options.width = 160;
    options.height = 90;
    options.lightSamples = "16";
    options.aovs = {"visibility"};
    penumbra::Renderer renderer(options);
    const penumbra::Frame frame = renderer.render(3);
    const auto& seen = frame.channels.at(0).values;
    const auto [low, high] = std::minmax_element(seen.begin(), seen.end());
    std::printf("%s: visibility from %g to %g on %s\n", frame.channels[0].name.c_str(), *low, *high,
                renderer.deviceName().c_str());
    return *low < 0.1F && *high == 1.0F && frame.rgba.size() == 4U * 160 * 90 ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return penumbra::exitCodeOf(error);
}
