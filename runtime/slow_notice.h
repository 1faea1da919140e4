// SPDX-License-Identifier: MIT
// Says on stderr what takes long, but only once it has taken longer than a second.
#pragma once
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace penumbra::runtime {

class SlowNotice {
  public:
    explicit SlowNotice(std::string what);
    ~SlowNotice();
    SlowNotice(const SlowNotice&) = delete;
    SlowNotice& operator=(const SlowNotice&) = delete;
    /// Turns all notices off (quiet mode).
    static void silence();

  private:
    std::string what_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool done_ = false;
    std::thread thread_;
};

}  // namespace penumbra::runtime
