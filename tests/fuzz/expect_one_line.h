// SPDX-License-Identifier: MIT
// What every target asks of a reader: a result, or an Error of one line. All else ends the process,
// which libFuzzer reports with the input.
#pragma once
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "runtime/error.h"

namespace penumbra::fuzz {

/// For what must hold of a result.
inline void expect(bool condition, const char* what) {
    if (condition) return;
    std::fprintf(stderr, "not as expected: %s\n", what);
    std::abort();
}

template <typename Read>
void expectOneLine(const Read& read) {
    try {
        read();
    } catch (const Error& error) {
        const std::string message = error.what();
        expect(!message.empty() && message.find('\n') == std::string::npos, message.c_str());
    }
}

/// A file in memory that readers open by its path.
class MemoryFile {
  public:
    MemoryFile(const std::uint8_t* bytes, std::size_t size) : descriptor_(memfd_create("fuzz", 0)) {
        expect(write(descriptor_, bytes, size) == static_cast<ssize_t>(size), "a file in memory");
    }
    ~MemoryFile() { close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

  private:
    int descriptor_;
};

}  // namespace penumbra::fuzz
