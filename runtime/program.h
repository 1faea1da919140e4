// SPDX-License-Identifier: MIT
// Compiled OpenCL programs. Sources are embedded at build time; see tools/embed_kernels.cpp.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "runtime/device.h"

namespace cl {
class Program;
}

namespace penumbra::runtime {

/// Text of a program (a row of `penumbra_program` in CMakeLists.txt), or null if there is none.
const char* programSource(const std::string& name);

/// One program built for one device. Cheap to copy.
class Program {
  public:
    /// Builds or loads `name` with the device's traits and `defines` ("NAME=VALUE"), which hold for
    /// the whole program. Throws Error with device, options and build log when it does not build.
    Program(Device& device, const std::string& name, const std::vector<std::string>& defines = {});

    Device& device() const { return *device_; }
    const std::string& name() const { return name_; }
    cl::Program& handle() const { return *program_; }
    /// Parameter types of each kernel as OpenCL C spells them, from the source's build.
    const std::map<std::string, std::vector<std::string>>& signatures() const {
        return signatures_;
    }

  private:
    bool load(const std::string& path);
    void build(const std::string& source, const std::string& options);
    void readSignatures();
    void save(const std::string& path) const;

    Device* device_;
    std::string name_;
    std::shared_ptr<cl::Program> program_;
    std::map<std::string, std::vector<std::string>> signatures_;
};

/// Folder of cached binaries: $XDG_CACHE_HOME/penumbra or ~/.cache/penumbra; empty if neither is
/// set.
std::string cacheFolder();

}  // namespace penumbra::runtime
