// SPDX-License-Identifier: MIT
// JSON with device, driver and version: penumbra_bench --benchmark_out=FILE
// --benchmark_out_format=json
#include "bench/support/bench.h"
#include "host/penumbra.h"

int main(int argc, char** argv) {
    const auto& info = penumbra::bench::device().info();
    benchmark::AddCustomContext("device", info.name);
    benchmark::AddCustomContext("driver", info.platform + " " + info.driver);
    benchmark::AddCustomContext("penumbra", penumbra::version());
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    std::fflush(stdout);
    std::_Exit(0);  // drivers that tear down at exit race with static objects
}
