// SPDX-License-Identifier: MIT
#pragma once

namespace penumbra::runtime {

/// Some drivers abort the process, PoCL for one where its cache is damaged. From here on that is
/// said in one line, with exit code 1. A file that grows too large is an error, not a signal. For
/// commands: a library leaves signals alone.
void announceCrashes();

/// Does it again where it was done: LLVM, within drivers, takes the signals for itself when it
/// first compiles, and would let the process die without a word.
void keepAnnouncingCrashes();

}  // namespace penumbra::runtime
