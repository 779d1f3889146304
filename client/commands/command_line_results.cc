#include <CLI/CLI.hpp>

#include "client/commands/command_parts.h"
#include "client/text/words.h"

namespace affskel::client {
namespace {

void add_output(CLI::App* sub, Options& options, const std::string& what) {
  sub->add_option("-o,--output", options.job.output, what)->required()->check(given())->type_name("FILE");
}

void add_fetch(CLI::App& app, Options& options) {
  CLI::App* sub = command(app, options, "fetch", Command::kFetch, "Write one artefact of a job",
                          "  affskel-client fetch @last field -o body.vtkhdf\n"
                          "  affskel-client fetch @last skeleton -o body.csv\n"
                          "  affskel-client fetch 3f2a9c mesh -o submitted.off\n"
                          "  affskel-client fetch @last divergence --operator sobel -o H.csv\n"
                          "  affskel-client fetch @last skeleton -o - --format csv | wc -l\n"
                          "Formats by extension: field and divergence .csv .dat .vtkhdf;\n"
                          "skeleton and eroded points .csv .ply .off .xyz .vtp; surface and eroded surface\n"
                          ".off .ply .obj .stl .vtp; mesh: the submitted bytes. Of an eroded solid this\n"
                          "is the one at a tenth of the volume; see erode");
  add_job(sub, options);
  sub->add_option("ARTEFACT", options.job.artifact, "What to fetch")
      ->required()
      ->check(CLI::IsMember({"field", "divergence", "skeleton", "surface", "eroded", "mesh"}))
      ->type_name("");
  std::vector<std::string> with_divergence = operator_names();
  std::erase(with_divergence, "chords");
  sub->add_option("--operator", options.job.skeleton.operator_name, "Of the divergence (default: the job's)")
      ->check(CLI::IsMember(with_divergence))
      ->type_name("OP");
  sub->callback([sub, &options] {
    options.command = Command::kFetch;
    if (sub->count("--operator") > 0 && options.job.artifact != "divergence") {
      throw CLI::ValidationError("--operator", "is for the divergence; see skeleton --help");
    }
    if (sub->count("--format") > 0 && options.job.artifact == "mesh") {
      throw CLI::ValidationError("--format", "the mesh is the submitted bytes; see transform --help");
    }
  });
  add_output(sub, options, "File to write; the format follows the extension; - is stdout");
  add_format(sub, options.job.format);
}

void add_skeleton(CLI::App& app, Options& options) {
  CLI::App* sub = command(app, options, "skeleton", Command::kSkeleton,
                          "Skeleton with other parameters, from the stored field",
                          "  affskel-client skeleton @last --threshold 5 -o fine.ply");
  add_job(sub, options);
  add_skeleton_options(sub, options.job.skeleton);
  add_output(sub, options, "File to write: .csv .ply .off .xyz .vtp, or -");
  add_format(sub, options.job.format);
}

void add_surface(CLI::App& app, Options& options) {
  CLI::App* sub = command(app, options, "surface", Command::kSurface,
                          "Triangulated skeleton: the alpha shape of its points, or the sheet of chords",
                          "  affskel-client surface @last -o skeleton.stl\n"
                          "  affskel-client surface @last --threshold 5 --alpha 160000 -o skeleton.obj");
  add_job(sub, options);
  add_skeleton_options(sub, options.job.skeleton);
  sub->add_option("--alpha", options.job.alpha, "Squared radius in mesh units squared (default: 3 DT^2)")
      ->check(positive_number())
      ->type_name("A");
  add_output(sub, options, "File to write: .off .ply .obj .stl .vtp, or -");
  add_format(sub, options.job.format);
}

void add_erode(CLI::App& app, Options& options) {
  CLI::App* sub = command(app, options, "erode", Command::kErode,
                          "Eroded solid: where E is at least a level, from the stored field",
                          "  affskel-client erode @last --fraction 5% -o eroded.stl\n"
                          "  affskel-client erode @last --volume 2e9 --as points -o eroded.ply\n"
                          "The volume that is left is told: of a surface what it encloses, of points their\n"
                          "share of the sample points times v0");
  add_job(sub, options);
  CLI::Option* fraction =
      sub->add_option("--fraction", options.job.fraction, "Level as a share of v0: 0.1 or 10%")
          ->transform(proper_share())
          ->type_name("F");
  sub->add_option("--volume", options.job.volume, "Level in mesh units cubed")
      ->check(positive_number())
      ->type_name("V")
      ->excludes(fraction);
  sub->add_option("--as", options.job.form, "points or surface (default: what the extension can hold)")
      ->check(CLI::IsMember({"points", "surface"}))
      ->type_name("FORM");
  sub->callback([sub, &options] {
    options.command = Command::kErode;
    if (sub->count("--fraction") + sub->count("--volume") == 0) {
      throw CLI::RequiredError("--fraction or --volume");
    }
  });
  add_output(sub, options,
             "Points: .csv .ply .off .xyz .vtp; surface: .off .ply .obj .stl .vtp; - is stdout");
  add_format(sub, options.job.format);
}

void add_render(CLI::App& app, Options& options) {
  CLI::App* sub = command(app, options, "render", Command::kRender, "Picture of the body with its skeleton",
                          "  affskel-client render @last -o body.png --width 2400\n"
                          "  affskel-client render @last --operator chords -o sheet.png\n"
                          "A skeleton by chords is drawn as its sheet, any other as its points");
  add_job(sub, options);
  add_skeleton_options(sub, options.job.skeleton);
  sub->add_option("--width", options.job.width, "Pixels")
      ->check(whole_in(200, 8000))
      ->capture_default_str()
      ->type_name("W");
  add_output(sub, options, "PNG file to write, or -");
}

void add_view(CLI::App& app, Options& options) {
  CLI::App* sub = command(app, options, "view", Command::kView,
                          "Page for any browser: the body and its skeleton to turn, with sliders for the\n"
                          "shock threshold and the erosion level; one file that needs no network",
                          "  affskel-client view @last -o body.html\n"
                          "  affskel-client view 3f2a9c --threshold 5 -o body.html");
  add_job(sub, options);
  add_skeleton_options(sub, options.job.skeleton);
  add_output(sub, options, "HTML file to write, or -");
}

}  // namespace

void add_result_commands(CLI::App& app, Options& options) {
  add_fetch(app, options);
  add_skeleton(app, options);
  add_surface(app, options);
  add_erode(app, options);
  add_render(app, options);
  add_view(app, options);
}

}  // namespace affskel::client
