#include "film_outputs.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>

#include "../error.hpp"
#include "outputs.hpp"

namespace realcam::app {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const std::string& film) {
    return film + ".frames";
}

std::string frame_of(const std::string& film, int frame) {
    return frame_file((fs::path(folder_of(film)) / "######.png").string(), frame);
}

}  // namespace

FilmOutputs::FilmOutputs(const std::vector<std::string>& outputs, const FilmWriter* writer) : writer_(writer) {
    std::partition_copy(outputs.begin(), outputs.end(), std::back_inserter(films_), std::back_inserter(pictures_),
                        is_film);
}

void FilmOutputs::check(const std::vector<int>& frames) const {
    if (!films_.empty() && frames.empty())
        throw InputError("--frames is missing: a film, .mp4, is made of frames, as of 1-240");
    if (!films_.empty() && !writer_)
        throw InputError("--output: \"" + films_.front() +
                         "\": this program writes pictures; realcam of Python (realcam[video]) makes films of them");
    std::vector<std::string> outputs = films_;
    for (const std::string& picture : pictures_)
        outputs.push_back(frames.empty() ? picture : frame_file(picture, frames.front()));
    check_outputs(outputs);
    for (const std::string& film : films_) writer_->check(film);
}

void FilmOutputs::begin() const {
    for (const std::string& film : films_) {
        std::error_code error;
        fs::create_directory(folder_of(film), error);
        if (error) throw ImageFileError(folder_of(film) + ": cannot be made: " + error.message());
    }
}

std::vector<std::string> FilmOutputs::all_files(const std::vector<int>& frames) const {
    std::vector<std::string> all = films_;
    for (const int frame : frames)
        for (std::string& file : files_of(frame)) all.push_back(std::move(file));
    return all;
}

std::vector<std::string> FilmOutputs::files_of(int frame) const {
    std::vector<std::string> files;
    for (const std::string& picture : pictures_) files.push_back(frame_file(picture, frame));
    for (const std::string& film : films_) files.push_back(frame_of(film, frame));
    return files;
}

std::vector<std::string> FilmOutputs::finish(const std::vector<int>& frames, double frames_per_second,
                                             const KeepGoing& keep_going) const {
    for (const std::string& film : films_) {
        std::vector<std::string> pictures;
        for (const int frame : frames) pictures.push_back(frame_of(film, frame));
        writer_->write(film, pictures, frames_per_second, keep_going);
        std::error_code error;  // leftover files do no harm
        for (const std::string& picture : pictures) fs::remove(picture, error);
        fs::remove(folder_of(film), error);  // fails if the folder holds other frames, which another video may need
    }
    return films_;
}

}  // namespace realcam::app
