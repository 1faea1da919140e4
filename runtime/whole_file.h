// SPDX-License-Identifier: MIT
// Files that bear their name only when they are whole, whatever kills the process.
#pragma once
#include <cstdint>
#include <cstdio>
#include <set>
#include <string>

namespace penumbra::runtime {

/// A file on its way to `path`: written under a temporary name in the same folder, which it keeps
/// locked, and renamed by commit(). Devices and pipes are written as they are. All errors are Error
/// naming `path` and the system's reason.
class WholeFile {
  public:
    explicit WholeFile(const std::string& path);
    /// Removes what was written unless commit() has been called.
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    const std::string& path() const { return path_; }
    void write(const void* data, std::size_t bytes);
    std::uint64_t position();
    void seek(std::uint64_t position);
    /// Throws if anything written so far was lost, even where a caller swallowed the exception.
    void check();
    /// Makes the file appear under its name. Throws as check() does.
    void commit();

  private:
    void openAsIs();
    void openTemporary();
    void fail();
    std::string path_, temporary_;  ///< temporary_ is empty for what cannot be renamed
    std::FILE* file_ = nullptr;
    int error_ = 0;  ///< errno of the first failure
};

/// Removes what killed processes have left of these files in `folder` (names without folder). What
/// a process is still writing is locked, and stays. Returns the number of files removed.
int removeAbandoned(const std::string& folder, const std::set<std::string>& names);

}  // namespace penumbra::runtime
