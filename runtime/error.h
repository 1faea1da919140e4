// SPDX-License-Identifier: MIT
// Errors that reach the user: one line, with the exit code that the command returns.
#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace penumbra {

/// Exit codes of the command; an Error carries one.
enum class ExitCode {
    done = 0,
    failed = 1,
    usage = 2,
    noDevice = 3,
    outOfMemory = 4,
    beyondLimit = 5,
    interrupted = 130
};

/// Anything that the caller or the machine got wrong. The message is one line that names the file,
/// option or kernel, the value found, the values allowed, and what to do. Our own mistakes are
/// assert()s instead.
class Error : public std::runtime_error {
  public:
    explicit Error(const std::string& message, ExitCode code = ExitCode::failed)
        : std::runtime_error(message), code_(code) {}
    ExitCode code() const { return code_; }

  private:
    ExitCode code_;
};

/// Throws Error (exit code 1) unless `condition`. State what is required AND what was found.
template <typename... Args>
void require(bool condition, fmt::format_string<Args...> message, Args&&... args) {
    if (!condition) throw Error(fmt::format(message, std::forward<Args>(args)...));
}

/// The same for usage errors (exit code 2).
template <typename... Args>
void requireUsage(bool condition, fmt::format_string<Args...> message, Args&&... args) {
    if (!condition) throw Error(fmt::format(message, std::forward<Args>(args)...), ExitCode::usage);
}

}  // namespace penumbra
