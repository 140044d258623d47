#include "film_bundle.hpp"

namespace realcam {

LensSystem with_round_stop(LensSystem lens) {
    lens.iris = {};
    return lens;
}

}  // namespace realcam
