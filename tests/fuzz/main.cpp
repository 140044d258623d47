// Driver of the fuzz targets where the compiler has no libFuzzer. Inputs are functions of the seed, so a run can be
// repeated; the first input that breaks something, crashes or hangs is saved as a file that replays it.

#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "inputs.hpp"

/// A sanitizer's finding becomes a signal, which saves the input.
extern "C" const char* __asan_default_options() {
    // In MB. A piece larger than the first is a promise that a file did not keep; the second is for all that is used.
    // OpenEXR takes, and does not touch, the 2 GB that an attribute may claim.
    return "abort_on_error=1:max_allocation_size_mb=2100:hard_rss_limit_mb=3000";
}
extern "C" const char* __ubsan_default_options() {
    return "abort_on_error=1:print_stacktrace=1";
}

namespace {

using namespace realcam::fuzz;

struct NamedTarget {
    const char* name;
    Target target;
    std::uint64_t Findings::* counts;  ///< counter that is compared with the requested number
    const char* unit;
    long hang_seconds;  ///< in user mode, for one input: a thousand times the usual time. The kernel takes seconds more
                        ///< to clear what a decoder allocates and a sanitizer touches.
};
#if defined(REALCAM_FUZZ_FILES)
constexpr NamedTarget kTargets[] = {
    {"obj", fuzz_obj, &Findings::files, "files", 10},
    {"mtl", fuzz_mtl, &Findings::files, "files", 10},
    {"gltf", fuzz_gltf, &Findings::files, "files", 10},
    {"glb", fuzz_glb, &Findings::files, "files", 10},
    {"compressed", fuzz_compressed, &Findings::files, "files", 10},
    {"ply", fuzz_ply, &Findings::files, "files", 10},
#if defined(REALCAM_FUZZ_SHOT_FILES)
    {"shot_file", fuzz_shot_file, &Findings::files, "files", 10},
#endif
#if defined(REALCAM_FUZZ_PICTURES)
    {"picture", fuzz_picture, &Findings::files, "files", 60},  // it may claim as many pixels as are allowed
#endif
};
#else
constexpr NamedTarget kTargets[] = {
    {"lens_trace", fuzz_lens_trace, &Findings::rays, "rays", 60},
    {"lens_file", fuzz_lens_file, &Findings::files, "files", 60},
    {"camera", fuzz_camera, &Findings::pupil_samples, "pupil samples", 60},
};
#endif

Input current;
std::string saved_as = "fuzz-input.bin";

/// Called from signal handlers: system calls alone.
void save(const Input& input) {
    const int file = open(saved_as.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644);
    if (file < 0) return;
    std::size_t done = 0;
    while (done < input.size()) {
        const ssize_t n = write(file, input.data() + done, input.size() - done);
        if (n <= 0) break;
        done += static_cast<std::size_t>(n);
    }
    close(file);
}

[[noreturn]] void end(int signal) {
    save(current);
    const char* what = signal == SIGVTALRM ? "realcam_fuzz: an input does not end\n" : "realcam_fuzz: crashed\n";
    if (write(STDERR_FILENO, what, std::strlen(what)) < 0) _exit(4);
    _exit(3);
}

/// Set by SIGINT and SIGTERM: the driver then stops and reports its progress.
volatile std::sig_atomic_t stopped = 0;

void watch() {
    for (const int signal : {SIGVTALRM, SIGSEGV, SIGFPE, SIGILL, SIGBUS, SIGABRT}) std::signal(signal, end);
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { stopped = 1; });
}

void start_clock(long seconds) {
    const itimerval limit{{0, 0}, {seconds, 0}};
    setitimer(ITIMER_VIRTUAL, &limit, nullptr);
}

int print(const Run& run, const NamedTarget& target) {
    const Findings& all = findings();
    const std::uint64_t count = all.*target.counts;
    std::printf("%s: %.4g %s of %llu inputs in %.1f s, %.3g/s; slowest input %.3f s; %llu broken\n", target.name,
                static_cast<double>(count), target.unit, static_cast<unsigned long long>(run.inputs), run.seconds,
                static_cast<double>(count) / run.seconds, run.slowest, static_cast<unsigned long long>(all.broken));
    if (all.rays)
        std::printf("  %.3g of the rays left their lens\n",
                    static_cast<double>(all.passed) / static_cast<double>(all.rays));
    if (all.files) std::printf("  %llu of the files could be read\n", static_cast<unsigned long long>(all.files_read));
    if (all.cameras)
        std::printf("  %llu of %llu cameras took %llu rays\n", static_cast<unsigned long long>(all.cameras_made),
                    static_cast<unsigned long long>(all.cameras), static_cast<unsigned long long>(all.camera_rays));
    for (const auto& [kind, found] : all.kinds)
        std::printf("  %llu x %s, first in input %llu\n    %s\n", static_cast<unsigned long long>(found.count),
                    kind.c_str(), static_cast<unsigned long long>(found.first_input), found.first.c_str());
    return all.broken == 0 ? 0 : 1;
}

int usage() {
    std::fprintf(stderr,
                 "PROGRAM TARGET COUNT [SEED] [FILE]   runs COUNT rays, files or samples; FILE is where the first\n"
                 "                                     input that breaks something is saved (fuzz-input.bin)\n"
                 "PROGRAM TARGET replay FILE           runs one saved input\n"
                 "targets:");
    for (const NamedTarget& target : kTargets) std::fprintf(stderr, " %s", target.name);
    std::fprintf(stderr, "\n");
    return 2;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) return usage();
    const NamedTarget* target = nullptr;
    for (const NamedTarget& known : kTargets)
        if (argv[1] == std::string(known.name)) target = &known;
    if (!target) return usage();
    if (argv[2] == std::string("replay")) {
        if (argc < 4) return usage();
        std::ifstream file(argv[3], std::ios::binary);
        const Input input{std::istreambuf_iterator<char>(file), {}};
        target->target(input.data(), input.size());
        return print({1, 1, 0, {}}, *target);
    }
    const double count = std::atof(argv[2]);
    const std::uint32_t seed = argc > 3 ? static_cast<std::uint32_t>(std::strtoul(argv[3], nullptr, 10)) : 1;
    if (argc > 4) saved_as = argv[4];
    watch();
    const Run run = run_inputs(
        target->target, seed, [&] { return stopped || static_cast<double>(findings().*target->counts) >= count; },
        [target](const Input& input) {
            current = input;
            start_clock(target->hang_seconds);
        });
    if (!run.first_broken.empty()) save(run.first_broken);
    return print(run, *target);
}
