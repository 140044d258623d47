#include "outputs.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <optional>
#include <regex>
#include <sstream>
#include <system_error>
#include <utility>

#include "../error.hpp"
#include "../image_io/image_file.hpp"
#include "../io/files/readable_file.hpp"
#include "../io/files/regular_file.hpp"
#include "../io/files/uri.hpp"
#include "../shot/shot_keys.hpp"

namespace realcam::app {
namespace {

namespace fs = std::filesystem;

/// True if both paths denote the same file, even if it does not exist yet.
bool same_file(const std::string& a, const std::string& b) {
    std::error_code error;
    if (fs::equivalent(a, b, error)) return true;
    return fs::weakly_canonical(a, error) == fs::weakly_canonical(b, error) && !error;
}

/// Writes a line with the value of a setting.
void write_value(std::ostream& text, const shot::SettingValue& value) {
    std::visit(
        [&]<class Value>(const Value& v) {
            if constexpr (std::is_same_v<Value, std::vector<std::string>>)
                for (const std::string& name : v) text << name << ',';
            else if constexpr (std::is_same_v<Value, std::vector<SpectrumPoint>>)
                for (const SpectrumPoint& point : v) text << point.wavelength_nm << ':' << point.power << ',';
            else if constexpr (!std::is_same_v<Value, std::monostate>)
                text << v;
        },
        value);
    text << '\n';
}

}  // namespace

bool is_video(const std::string& output) {
    return io::suffix_of(output) == ".mp4";
}

void check_outputs(const std::vector<std::string>& outputs) {
    for (auto it = outputs.begin(); it != outputs.end(); ++it) {
        if (!is_video(*it)) image_io::check_image_path(*it);
        if (std::any_of(outputs.begin(), it, [&](const std::string& other) { return same_file(other, *it); }))
            throw InputError("--output: \"" + *it + "\" is specified twice");
    }
}

std::string settings_digest(const shot::ShotRequest& request, const Camera& camera,
                            const std::string& further_settings) {
    std::ostringstream text;
    text.precision(17);  // distinguishes all doubles
    for (const auto& [name, value] : io::metadata_of(camera, request.settings).entries())
        if (name != "realcam:version") text << name << '=' << value << '\n';
    const shot::PictureRequest picture = shot::request_of(request.settings);
    for (const shot::ShotKey& key : shot::shot_keys())
        if (key.get && key.name != std::string_view("threads")) write_value(text << key.name << '=', key.get(picture));
    // Settings of the shot that the metadata lack; -1 stands for a value that is not specified.
    const Vec3f light = request.environment_cd_m2.value_or(Vec3f{-1, -1, -1});
    text << camera.film.width << ' ' << camera.film.height << ' ' << request.scale << ' ' << light.x << ' ' << light.y
         << ' ' << light.z << ' ' << request.environment_change.scale << ' ' << request.environment_change.rotation_deg
         << ' ' << static_cast<int>(request.tone) << ' ' << request.denoises << ' ' << request.meters_exposure_time()
         << ' ' << request.iso_follows_s.value_or(-1) << ' ' << request.environment_layer << '\n'
         << static_cast<int>(request.exr_color_space) << '\n';
    for (const std::string& variant : request.variants) text << variant << '\n';
    text << request.scene_name << '\n';
    if (const std::optional<Air>& air = request.air)
        text << air->extinction.r << ' ' << air->extinction.g << ' ' << air->extinction.b << ' ' << air->albedo.r << ' '
             << air->albedo.g << ' ' << air->albedo.b << ' ' << air->anisotropy << ' ' << air->margin_m.value_or(-1)
             << '\n';
    // The contents of configuration files are hashed below, as those of all inputs.
    const shot::OcioRequest& ocio = request.ocio;
    for (const std::string& name : {ocio.config.starts_with(shot::kBuiltInConfig) ? ocio.config : "", ocio.display,
                                    ocio.view, ocio.environment_color_space, ocio.texture_color_space})
        text << name << '\n';
    text << further_settings;
    // The 64-bit FNV-1a hash: http://www.isthe.com/chongo/tech/comp/fnv
    constexpr std::uint64_t kOffsetBasis = 0xcbf29ce484222325, kPrime = 0x100000001b3;
    std::uint64_t digest = kOffsetBasis;
    const auto add = [&](std::string_view bytes) {
        for (const char c : bytes) digest = (digest ^ static_cast<unsigned char>(c)) * kPrime;
    };
    add(text.str());
    // Hashes the contents alone, in an order independent of file names, so that a folder may be renamed between two
    // runs.
    std::vector<std::string> contents;
    for (const std::string& path : io::recorded_inputs()) {
        io::RegularFile file(path);
        const std::uint64_t settings_hash = std::exchange(digest, kOffsetBasis);
        std::string buffer(1 << 20, '\0');
        while (const std::size_t n = file.read(buffer.data(), buffer.size()))
            add(std::string_view(buffer).substr(0, n));
        contents.push_back(std::to_string(std::exchange(digest, settings_hash)));
    }
    std::sort(contents.begin(), contents.end());
    for (const std::string& content : contents) add(content + '\n');
    char digits[20];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(digest));
    return digits;
}

std::vector<int> frame_numbers(const std::string& text) {
    static const std::regex kRange(R"((\d{1,6})(?:-(\d{1,6})(?:x(\d{1,6}))?)?)");
    std::smatch found;
    std::vector<int> numbers;
    if (std::regex_match(text, found, kRange)) {
        const auto number = [&](std::size_t group, int default_value) {
            return found[group].matched ? std::stoi(found[group]) : default_value;
        };
        const int first = number(1, 0), last = number(2, first), step = number(3, 1);
        for (int n = first; n <= last && step > 0; n += step) numbers.push_back(n);
    }
    if (numbers.empty())
        throw InputError("--frames: \"" + text.substr(0, 40) +
                         "\": expected a number, or a range with the smaller number first, such as 1-240 or 1-240x2");
    return numbers;
}

std::string frame_file(const std::string& output, int number) {
    const std::filesystem::path path(output);
    const std::string name = path.filename().string();
    const std::size_t end = name.find_last_of('#');
    const std::size_t begin = end == name.npos ? end : name.find_last_not_of('#', end) + 1;  // npos + 1 is 0
    constexpr std::size_t kMaxDigits = 20;
    char digits[24];
    std::snprintf(digits, sizeof digits, "%0*d",
                  end == name.npos ? 4 : static_cast<int>(std::min(end + 1 - begin, kMaxDigits)), number);
    const std::string numbered = end == name.npos ? path.stem().string() + '.' + digits + path.extension().string()
                                                  : name.substr(0, begin) + digits + name.substr(end + 1);
    return (path.parent_path() / numbered).string();
}

namespace {

/// Folder that holds the frames of a video until it is complete.
std::string frame_folder(const std::string& video) {
    return video + ".frames";
}

/// File name of a frame's picture in the video's frame folder.
std::string frame_picture(const std::string& video, int frame) {
    return frame_file((fs::path(frame_folder(video)) / "######.png").string(), frame);
}

}  // namespace

OutputFiles::OutputFiles(const std::vector<std::string>& outputs, const VideoWriter* writer) : writer_(writer) {
    std::partition_copy(outputs.begin(), outputs.end(), std::back_inserter(videos_), std::back_inserter(pictures_),
                        is_video);
}

void OutputFiles::check(const std::vector<int>& frames) const {
    if (!videos_.empty() && frames.empty())
        throw InputError("--frames is missing: a video (.mp4) needs the numbers of its frames, such as 1-240");
    if (!videos_.empty() && !writer_)
        throw InputError("--output: \"" + videos_.front() +
                         "\": this program writes no videos; the command of the Python package realcam[video] does");
    std::vector<std::string> outputs = videos_;
    for (const std::string& picture : pictures_)
        outputs.push_back(frames.empty() ? picture : frame_file(picture, frames.front()));
    check_outputs(outputs);
    for (const std::string& video : videos_) writer_->check(video);
}

void OutputFiles::create_frame_folders() const {
    for (const std::string& video : videos_) {
        std::error_code error;
        fs::create_directory(frame_folder(video), error);
        if (error) throw ImageFileError(frame_folder(video) + ": cannot be created: " + error.message());
    }
}

std::vector<std::string> OutputFiles::all_files(const std::vector<int>& frames) const {
    std::vector<std::string> all = videos_;
    for (const int frame : frames)
        for (std::string& file : files_of(frame)) all.push_back(std::move(file));
    return all;
}

std::vector<std::string> OutputFiles::files_of(int frame) const {
    std::vector<std::string> files;
    for (const std::string& picture : pictures_) files.push_back(frame_file(picture, frame));
    for (const std::string& video : videos_) files.push_back(frame_picture(video, frame));
    return files;
}

std::vector<std::string> OutputFiles::encode_videos(const std::vector<int>& frames, double frames_per_second,
                                                    const KeepGoing& keep_going) const {
    for (const std::string& video : videos_) {
        std::vector<std::string> pictures;
        for (const int frame : frames) pictures.push_back(frame_picture(video, frame));
        writer_->write(video, pictures, frames_per_second, keep_going);
        std::error_code error;  // leftover files do no harm
        for (const std::string& picture : pictures) fs::remove(picture, error);
        fs::remove(frame_folder(video), error);  // fails if the folder holds other frames, which another video may need
    }
    return videos_;
}

}  // namespace realcam::app
