#pragma once
#include <string>
#include <vector>

#include "lens_error.hpp"
#include "lens_file.hpp"
#include "lens_prescription.hpp"

namespace realcam::io {

/// Names all that a file has and realcam has no model of: as warnings where that is forced, else as one LensFileError.
void refuse_foreign(const std::vector<ForeignFeature>& features, const std::string& file,
                    const LensReadOptions& options);

}  // namespace realcam::io
