// SPDX-License-Identifier: MIT
#include "runtime/digest.h"

#include <fmt/format.h>

#include <cstdint>

namespace penumbra::runtime {

std::string digest(const void* data, std::size_t bytes) {
    __extension__ using Wide = unsigned __int128;
    const Wide prime = (static_cast<Wide>(0x0000000001000000ULL) << 64) | 0x000000000000013BULL;
    Wide hash = (static_cast<Wide>(0x6c62272e07bb0142ULL) << 64) | 0x62b821756295c58dULL;
    const auto* byte = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i) hash = (hash ^ byte[i]) * prime;
    return fmt::format("{:016x}{:016x}", static_cast<std::uint64_t>(hash >> 64),
                       static_cast<std::uint64_t>(hash));
}

}  // namespace penumbra::runtime
