// SPDX-License-Identifier: MIT
// Temporary names are NAME.PID-N.tmp. Processes of several machines or containers may share a
// folder and have the same number, so names are claimed exclusively; and a lock, not the number,
// tells whether the writer lives.
#include "runtime/whole_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "runtime/error.h"

namespace penumbra::runtime {
namespace {

namespace fs = std::filesystem;
constexpr const char* kEnd = ".tmp";
constexpr int kMostAttempts = 10000;

bool isUnlinked(int descriptor) {
    struct stat status {};
    return fstat(descriptor, &status) == 0 && status.st_nlink == 0;
}

/// NAME of a temporary name NAME.PID-N.tmp; empty for any other.
std::string finalName(const std::string& temporary) {
    if (!temporary.ends_with(kEnd)) return "";
    const auto end = temporary.size() - std::strlen(kEnd);
    const auto dot = temporary.find_last_of('.', end - 1);
    if (dot == std::string::npos || dot + 1 == end) return "";
    const bool numbers = std::all_of(temporary.begin() + static_cast<std::ptrdiff_t>(dot) + 1,
                                     temporary.begin() + static_cast<std::ptrdiff_t>(end),
                                     [](char c) { return (c >= '0' && c <= '9') || c == '-'; });
    return numbers ? temporary.substr(0, dot) : "";
}

}  // namespace

WholeFile::WholeFile(const std::string& path) : path_(path) {
    std::error_code ignored;
    const auto status = fs::status(path, ignored);
    if (fs::is_directory(status))
        error_ = EISDIR;
    else if (fs::exists(status) && !fs::is_regular_file(status))
        openAsIs();
    else
        openTemporary();
    check();
}

void WholeFile::openAsIs() {
    file_ = std::fopen(path_.c_str(), "wb");
    if (!file_) fail();
}

void WholeFile::openTemporary() {
    for (int n = 0; !file_ && !error_; ++n) {
        temporary_ = fmt::format("{}.{}-{}{}", path_, getpid(), n, kEnd);
        const int flags = O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC;
        const int descriptor = ::open(temporary_.c_str(), flags, 0666);
        if (descriptor < 0) {
            if (errno != EEXIST || n >= kMostAttempts) fail();
            continue;
        }
        flock(descriptor, LOCK_EX);  // where there are no locks, nothing is removed as abandoned
        if (isUnlinked(descriptor))
            close(descriptor);  // taken for abandoned before it was locked
        else if (!(file_ = fdopen(descriptor, "wb")))
            fail();
    }
}

WholeFile::~WholeFile() {
    if (!file_) return;
    if (!temporary_.empty()) unlink(temporary_.c_str());
    std::fclose(file_);
}

void WholeFile::fail() {
    if (error_ == 0) error_ = errno ? errno : EIO;
}

void WholeFile::check() {
    require(error_ == 0, "{}: cannot be written: {}", path_, std::strerror(error_));
}

void WholeFile::write(const void* data, std::size_t bytes) {
    if (std::fwrite(data, 1, bytes, file_) != bytes) fail();
    check();
}

std::uint64_t WholeFile::position() {
    return static_cast<std::uint64_t>(ftello(file_));
}

void WholeFile::seek(std::uint64_t position) {
    if (fseeko(file_, static_cast<off_t>(position), SEEK_SET) != 0) fail();
    check();
}

void WholeFile::commit() {
    if (std::fflush(file_) != 0) fail();
    // Some file systems report a full disk only when a descriptor is closed. A copy's is, and
    // leaves the lock.
    const int copy = dup(fileno(file_));
    if (copy < 0 || close(copy) != 0) fail();
    check();
    if (!temporary_.empty() && rename(temporary_.c_str(), path_.c_str()) != 0) fail();
    check();
    std::fclose(file_);
    file_ = nullptr;
}

int removeAbandoned(const std::string& folder, const std::set<std::string>& names) {
    int removed = 0;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        if (!names.contains(finalName(entry->path().filename().string()))) continue;
        const int descriptor = ::open(entry->path().c_str(), O_RDWR | O_CLOEXEC);
        if (descriptor < 0) continue;
        if (flock(descriptor, LOCK_EX | LOCK_NB) == 0 && unlink(entry->path().c_str()) == 0)
            ++removed;
        close(descriptor);
    }
    return removed;
}

}  // namespace penumbra::runtime
