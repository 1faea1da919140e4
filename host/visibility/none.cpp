// SPDX-License-Identifier: MIT
#include "host/visibility/none.h"

#include "kernels/shared/multi_view.h"

namespace penumbra::visibility {

None::None(const TechniqueContext& context) {
    parseSettings<NoSettings>("none", context.values);
}

void None::run(const Inputs&, Visibility& visibility) {
    visibility.channels = 1;
    visibility.planes.fill(1.0F);
    visibility.state.fill(STATE_LIT);
}

}  // namespace penumbra::visibility
