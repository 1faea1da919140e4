// SPDX-License-Identifier: MIT
// The rival: Embree with its fastest shadow rays. Packets hold a block of light samples of one
// pixel; the threads of all cores take pixels as they go.
#pragma once
#include <memory>

#include "bench/papers/mask_scene.h"

namespace penumbra::papers {

class EmbreeShadows {
  public:
    /// `robust`: watertight edges, for exactness; else as fast as it gets.
    EmbreeShadows(const std::vector<glm::vec3>& corners, bool robust);
    ~EmbreeShadows();
    double buildSeconds() const { return buildSeconds_; }

    /// Seconds of all shadow rays, in the faster of packets of 8 and of 16. `samples` [rows,
    /// columns]. hidden [receiver, words of 32 samples] is filled where not null.
    double trace(const std::vector<MaskScene::Receiver>& receivers,
                 const std::vector<glm::dvec3>& samples, int columns, int rows,
                 std::vector<std::uint32_t>* hidden = nullptr) const;
    int threads() const;

  private:
    struct Handles;
    std::unique_ptr<Handles> handles_;
    double buildSeconds_ = 0;
};

}  // namespace penumbra::papers
