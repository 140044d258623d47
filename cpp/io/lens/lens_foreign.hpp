#pragma once
#include <string>
#include <vector>

#include "lens_error.hpp"
#include "lens_file.hpp"
#include "lens_prescription.hpp"

namespace realcam::io {

/// Reports all features of a file that realcam does not model: as warnings if `options.force` is set, otherwise as one
/// LensFileError.
void refuse_foreign(const std::vector<ForeignFeature>& features, const std::string& file,
                    const LensReadOptions& options);

}  // namespace realcam::io
