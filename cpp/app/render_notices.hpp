#pragma once
#include <chrono>
#include <string>
#include <vector>

#include "../camera/film/camera.hpp"
#include "../camera/film/develop.hpp"
#include "../render/film/image.hpp"
#include "../shot/shot.hpp"
#include "../shot/shot_request.hpp"

namespace realcam::app {

/// Messages about the expected duration of a picture with a noise goal.
class SamplingNotice {
public:
    SamplingNotice(const NoiseGoal& goal, shot::Sampling sampling) : goal_(goal), sampling_(sampling) {}

    /// The noise goal and the time limit, in a line.
    std::string aim() const;

    /// Records that a fraction of the samples is taken, from 0 to 1. Returns the fraction done: the larger of `share`
    /// and the elapsed fraction of the time limit.
    double took(double share);

    /// The expected duration, in a line, the first time it can be estimated. Empty at other times and for short
    /// durations.
    std::string expectation();

private:
    using Clock = std::chrono::steady_clock;

    NoiseGoal goal_;
    shot::Sampling sampling_;
    Clock::time_point start_ = Clock::now();
    double elapsed_s_ = 0, share_ = 0;
    bool has_reported_ = false;
};

/// Stops by which the metered exposure of a picture lies above middle grey; -infinity for a black picture.
double stops_above_grey(const Image& image, double iso);

/// Warning about a picture that is nearly all black or white once developed: by how many stops it is off, and which
/// settings to change. Empty for any other picture.
std::string exposure_notice(const Image& image, const Camera& camera, ToneCurve tone);

/// Summary of a picture and its cost, in some lines. `seconds`: wall-clock time of the whole command. `verbose`: adds
/// rays per second, and the time by stage. `denoiser`: its name, empty if the picture was not denoised.
std::string summary(const shot::Shot& shot, const RenderSettings& settings, const Image& image,
                    const std::vector<std::string>& pictures, const std::string& denoiser, double seconds,
                    bool verbose);

/// One-line summary of a frame of a film.
std::string frame_summary(int frame, const Camera& camera, const std::vector<std::string>& pictures);

}  // namespace realcam::app
