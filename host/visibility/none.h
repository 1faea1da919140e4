// SPDX-License-Identifier: MIT
#pragma once
#include "host/visibility/technique.h"

namespace penumbra::visibility {

struct NoSettings {
    template <typename Row>
    void rows(Row&) {}
};

/// No shadows: every pixel sees the whole light.
class None : public Technique {
  public:
    explicit None(const TechniqueContext& context);
    bool hasDepthMaps() const override { return false; }
    void run(const Inputs& inputs, Visibility& visibility) override;
};

}  // namespace penumbra::visibility
