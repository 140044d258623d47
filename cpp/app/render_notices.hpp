#pragma once
#include <chrono>
#include <string>
#include <vector>

#include "../camera/film/camera.hpp"
#include "../render/film/image.hpp"
#include "../shot/shot.hpp"
#include "../shot/shot_request.hpp"

namespace realcam::app {

/// Messages about the noise goal of a picture and the time expected to reach it.
class SamplingNotice {
public:
    SamplingNotice(const NoiseGoal& goal, shot::Sampling sampling) : goal_(goal), sampling_(sampling) {}

    /// The noise goal and the time limit, in a line.
    std::string goal_text() const;

    /// Records the fraction of the samples that has been taken, 0 to 1, and the time. Returns the progress to display,
    /// 0 to 1: the larger of `fraction` and the elapsed fraction of the time limit.
    double update(double fraction);

    /// Returns the expected duration, in a line, at the first call at which it can be estimated; empty at other calls
    /// and for durations below 3 s.
    std::string duration_notice();

private:
    using Clock = std::chrono::steady_clock;

    NoiseGoal goal_;
    shot::Sampling sampling_;
    Clock::time_point start_ = Clock::now();
    double elapsed_s_ = 0, fraction_ = 0;
    bool has_reported_ = false;
};

/// Stops by which the metered exposure of a picture lies above middle grey; -infinity for a black picture.
double stops_above_grey(const Image& image, double iso);

/// Warning about a picture that is nearly all black or white once developed: by how many stops it is off, and which
/// settings to change. Empty for any other picture.
std::string exposure_notice(const Image& image, const Camera& camera, const View& view);

/// Summary of a picture and its cost, in some lines. `pictures`: files that were written. `denoiser`: its name, empty
/// if the picture was not denoised. `seconds`: wall-clock time of the whole command. `verbose`: adds rays per second,
/// and the time by stage.
std::string summary(const shot::Shot& shot, const RenderSettings& settings, const Image& image,
                    const std::vector<std::string>& pictures, const std::string& denoiser, double seconds,
                    bool verbose);

/// One-line summary of a frame of a video: its number, the state of the camera, and the files that were written.
std::string frame_summary(int frame, const Camera& camera, const std::vector<std::string>& pictures);

}  // namespace realcam::app
