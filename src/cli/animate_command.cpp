// SPDX-License-Identifier: MIT
/// How does a file with motion, or a camera on its way around a scene, become a film?
#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/camera_options.hpp"
#include "cli/command.hpp"
#include "cli/footage.hpp"
#include "cli/frame_files.hpp"
#include "cli/frame_report.hpp"
#include "cli/interrupt.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/structure.hpp"
#include "cli/text.hpp"
#include "core/exact_math.hpp"
#include "setka/device_scene.hpp"
#include "setka/error.hpp"
#include "setka/io.hpp"
#include "setka/renderer.hpp"
#include "setka/version.hpp"
#include "trace/names.hpp"
#include "workload/measure.hpp"

namespace setka::cli {

namespace {

struct Options {
    SceneInput input;
    DeviceSelection device;
    StructureChoice structure;
    RenderOptions render;
    PictureOptions picture;
    CameraOptions camera;
    std::string output, animation;
    MomentChoice moments;
    std::optional<double> orbit_degrees_per_second;
    ProgressMode progress = ProgressMode::Auto;
    bool resumes = false, digests = false, as_json = false;
};

/// Turns a point or direction about the vertical axis through `centre`.
[[nodiscard]] Float3 turned(const Float3& p, const Float3& centre, double degrees) {
    const auto [sine, cosine] = exact::sin_cos(std::remainder(degrees, 360.0) * exact::pi / 180);
    const double x = double(p.x) - centre.x, z = double(p.z) - centre.z;
    return {float(centre.x + (cosine * x + sine * z)), p.y, float(centre.z + (cosine * z - sine * x))};
}

/// Where the camera is at each moment.
class CameraPath {
  public:
    CameraPath(const Footage& footage, const Options& options, const std::function<Bounds()>& bounds)
        : options_(options), orbit_(options.moments.orbit_degrees_per_second) {
        const float aspect = float(options.render.width) / float(options.render.height);
        const auto seen = [&] { return orbit_ != 0 ? round(bounds()) : bounds(); };
        first_ = options.camera.choose(footage.scene().camera, seen, aspect);
        // The axis: what is looked at, or the middle of what moves where that is the file's own business.
        const bool is_of_file = footage.scene().camera && !options.camera.is_own();
        centre_ = first_.target;
        if (orbit_ != 0 && is_of_file) {
            const Bounds box = bounds();
            centre_ = {box.lower[0] / 2 + box.upper[0] / 2, 0, box.lower[2] / 2 + box.upper[2] / 2};
        }
    }

    [[nodiscard]] const Camera& first() const { return first_; }

    [[nodiscard]] Camera at(const Moment& moment, const SceneUpdate& update) const {
        Camera camera = first_;
        if (update.camera && !options_.camera.is_own()) {
            camera = *update.camera;
            camera.vertical_fov_degrees = options_.camera.fov_degrees.value_or(camera.vertical_fov_degrees);
        }
        if (orbit_ == 0) return camera;
        const double degrees = orbit_ * moment.seconds;
        camera.eye = turned(camera.eye, centre_, degrees);
        camera.target = turned(camera.target, centre_, degrees);
        camera.up = turned(camera.up, {}, degrees);
        return camera;
    }

  private:
    /// As wide as the box is when it is seen from any side.
    [[nodiscard]] static Bounds round(Bounds box) {
        const double width = double(box.upper[0]) - box.lower[0], depth = double(box.upper[2]) - box.lower[2];
        const double radius = std::sqrt(width * width + depth * depth) / 2;
        for (const int axis : {0, 2}) {
            const double middle = (double(box.lower[axis]) + box.upper[axis]) / 2;
            box.lower[axis] = float(middle - radius);
            box.upper[axis] = float(middle + radius);
        }
        return box;
    }

    const Options& options_;
    double orbit_;
    Camera first_;
    Float3 centre_;
};

/// Everything that a picture's pixels depend on, for runs that are resumed. The device, the structure and the
/// density are not among it: they change no pixel, but for the views of the work that a ray makes.
[[nodiscard]] nlohmann::ordered_json settings_of(const Options& options, const Footage& footage,
                                                 const Camera& camera) {
    const auto point = [](const Float3& p) { return nlohmann::ordered_json{p.x, p.y, p.z}; };
    nlohmann::ordered_json files = nlohmann::ordered_json::array();
    for (const std::filesystem::path& file : footage.files())
        files.push_back({as_utf8(file.string()), std::filesystem::file_size(file),
                         std::chrono::duration_cast<std::chrono::nanoseconds>(
                             std::filesystem::last_write_time(file).time_since_epoch())
                             .count()});
    nlohmann::ordered_json settings{
        {"setka", version()},
        {"scene", as_utf8(options.input.files)},
        {"triangles", options.input.triangles},
        {"animation", options.animation},
        {"size", fmt::format("{}x{}", options.render.width, options.render.height)},
        {"samples", options.render.samples_per_axis},
        {"depth", options.render.max_depth},
        {"view", name_of(options.render.view)},
        {"fps", options.moments.frames_per_second},
        {"orbit", options.moments.orbit_degrees_per_second},
        {"up", point(options.camera.up)},
        {"eye", point(camera.eye)},
        {"target", point(camera.target)},
        {"fov", camera.vertical_fov_degrees},
        {"own_camera", options.camera.is_own()},
    };
    if (options.render.view == View::Steps || options.render.view == View::Tests) {
        const GridOptions& grid = options.structure.grid;
        settings["grid"] = {to_string(options.structure.kind), grid.density, grid.max_cells_per_axis,
                            name_of(options.render.trace.step)};
    }
    settings["files"] = files;
    settings["contents"] = footage.digest();
    return settings;
}

/// The work of a film, picture by picture.
class Film {
  public:
    Film(const Options& options, const Footage& footage, const CameraPath& cameras, const FramePath& path)
        : options_(options),
          footage_(footage),
          cameras_(cameras),
          path_(path),
          device_(options.device.open()),
          queue_(make_interruptible_queue(device_)),
          scene_(queue_, lit_scene()) {
        if (path.is_film()) gif_.emplace(path.text(), options.moments.frames_per_second);
    }

    [[nodiscard]] FrameReport make(const Moment& moment, const std::function<void(double)>& progress) {
        FrameReport report{moment, path_.of(moment.number).string(), false, {}, {}};
        const workload::Stopwatch total;
        const auto timed = [](double& time_ms, const auto& work) {
            const workload::Stopwatch watch;
            work();
            time_ms = watch.elapsed_ms();
        };
        SceneUpdate update;
        timed(report.times.pose_ms, [&] { update = footage_.at(moment); });
        timed(report.times.upload_ms, [&] {
            scene_.apply(queue_, update);
            queue_.finish();
        });
        std::unique_ptr<Structure> structure;
        timed(report.times.build_ms, [&] {
            structure = options_.structure.build(queue_, scene_);
            queue_.finish();
        });
        if (options_.digests) report.digest = dynamic_cast<const Grid&>(*structure).digest(queue_);
        (void)queue_.take_timings();
        RenderOptions render = options_.render;
        render.progress = progress;
        const Image image = Renderer(render).render(queue_, scene_, *structure, cameras_.at(moment, update));
        add_stages(report.times, queue_.take_timings());
        timed(report.times.write_ms, [&] {
            if (gif_) gif_->add(image);
            else io::write_image(report.file, image);
        });
        report.times.total_ms = total.elapsed_ms();
        return report;
    }

    void finish() {
        end_interruptible_work();
        if (gif_) gif_->finish();
    }

    [[nodiscard]] FilmReport report(std::vector<FrameReport> frames) const {
        return {path_.text(),
                device_.info().id,
                device_.info().name,
                to_string(options_.structure.kind),
                options_.render.width,
                options_.render.height,
                scene_.triangle_count(),
                std::move(frames)};
    }

  private:
    [[nodiscard]] Scene lit_scene() const {
        Scene scene = footage_.scene();
        if (scene.point_lights.empty() && scene.directional_lights.empty())
            add_default_lights(scene, cameras_.first());
        return scene;
    }

    const Options& options_;
    const Footage& footage_;
    const CameraPath& cameras_;
    const FramePath& path_;
    Device device_;
    Queue queue_;
    DeviceScene scene_;
    std::optional<io::GifFile> gif_;
};

void check(const Options& options) {
    const auto fail = [](const std::string& message) {
        throw Error(ErrorCategory::InvalidArgument, message);
    };
    if (options.digests && options.structure.kind != StructureKind::UniformGrid)
        fail("--digests are of grids; accepted with --structure grid");
    (void)Renderer(options.render);  // checks its options
}

[[nodiscard]] ExitCode run(Options options) {
    options.picture.complete(options.render);
    check(options);
    Progress progress(options.progress);
    progress.update("loading", 0);
    const Footage footage(options.input, options.animation, options.camera.up);
    const bool stands_still = footage.kind() == io::MotionKind::None;
    options.moments.orbit_degrees_per_second =
        options.orbit_degrees_per_second.value_or(stands_still ? 36 : 0);
    const std::vector<Moment> moments = footage.moments(options.moments);
    const FramePath path(options.output, moments.size());
    if (!path.is_numbered() && options.resumes)
        throw Error(ErrorCategory::InvalidArgument,
                    fmt::format("--resume: {} is one file; accepted are numbered pictures such as %04d.png",
                                options.output));
    if (!path.is_film()) io::check_image_writable(path.of(moments.front().number));
    const CameraPath cameras(footage, options, [&] {
        return footage.bounds([&](double share) { progress.update("framing", share); });
    });
    std::optional<FrameLog> log;
    if (path.is_numbered())
        log.emplace(path, settings_of(options, footage, cameras.first()),
                    options.resumes ? FrameLog::Start::Resume : FrameLog::Start::Anew, moments);

    Film film(options, footage, cameras, path);
    std::vector<FrameReport> frames;
    for (const Moment& moment : moments) {
        if (log && log->has(moment.number)) {
            frames.push_back({moment, path.of(moment.number).string(), true, {}, {}});
            continue;
        }
        const auto tell = [&](double share) {
            progress.update("animating", (double(frames.size()) + share) / double(moments.size()),
                            fmt::format("picture {} of {}", frames.size() + 1, moments.size()));
        };
        tell(0);
        frames.push_back(film.make(moment, tell));
        if (log) log->add(moment.number);
    }
    film.finish();
    progress.clear();
    const FilmReport report = film.report(std::move(frames));
    fmt::print("{}", options.as_json ? film_as_json(report) : film_as_text(report));
    return exit_ok;
}

void add_time_options(CLI::App& app, Options& options) {
    const std::string group = "Time";
    const auto bound = [](const std::string& option, const std::string& text) {
        return std::optional(parse_number(option, text, {0, 4e9}));
    };
    add_parsed(app, "--from", options.moments.from, bound, "TIME",
               "first moment: seconds, or a frame's number in a sequence")
        ->group(group);
    add_parsed(app, "--to", options.moments.to, bound, "TIME", "last moment, likewise; by default the end")
        ->group(group);
    add_parsed(
        app, "--fps", options.moments.frames_per_second,
        [](const std::string& option, const std::string& text) {
            return parse_number(option, text, {0.001, 1000});
        },
        "NUMBER", "pictures a second", "24")
        ->group(group);
    app.add_option("--animation", options.animation, "one of a glTF file, by name or number; else the first")
        ->type_name("NAME")
        ->group(group);
}

}  // namespace

Command add_animate_command(CLI::App& program) {
    const auto options = std::make_shared<Options>();
    CLI::App* app =
        program.add_subcommand("animate", "Render a film: what moves in a file, or a turn around it");
    options->input.add_to(
        *app,
        "a glTF or GLB file with animation; or frames: a folder, a pattern such as cloth%03d.ply, or several "
        "numbered files; or anything that stands still");
    app->add_option("-o,--output", options->output, "numbered pictures such as out/%04d.png, or one GIF")
        ->type_name("FILE")
        ->required();
    add_time_options(*app, *options);
    options->picture.add_to(*app, options->render);
    app->add_flag("--resume", options->resumes,
                  "keep pictures that an interrupted run with the same options completed");
    app->add_flag("--digests", options->digests, "tell the digest of each picture's grid");
    add_progress_option(*app, options->progress);
    app->add_flag("--json", options->as_json, "print JSON");
    options->camera.add_to(*app);
    add_parsed(
        *app, "--orbit", options->orbit_degrees_per_second,
        [](const std::string& option, const std::string& text) {
            return std::optional(parse_number(option, text, {-36000, 36000}));
        },
        "DEGREES", "how far the camera goes around in a second; 36 by default if nothing else moves, else 0")
        ->group("Camera");
    options->structure.add_to(*app);
    add_step_option(*app, options->render.trace.step);
    options->device.add_to(*app);
    return {app, [options] { return run(*options); }};
}

}  // namespace setka::cli
