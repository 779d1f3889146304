#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>

#include "client/commands/commands.h"
#include "client/commands/shared/destination.h"
#include "client/commands/shared/job_options.h"
#include "client/commands/shared/skeleton_options.h"
#include "client/commands/shared/transfer.h"
#include "client/text/words.h"
#include "wire/params.h"

namespace affskel::client {
namespace {

struct Options {
  std::string job, artifact, output, format;
  SkeletonOptions skeleton;  // of the divergence; no operator: the job's
};

// The mesh is written as it was submitted, OFF text, even where the file's name promises another format.
void warn_of_foreign_extension(Context& context, const Destination& destination) {
  const std::string extension = destination.extension();
  for (const FileFormat format : surface_formats()) {
    if (format == FileFormat::kOff || extension != extension_of(format)) continue;
    context.console().warning(destination.name() +
                              ": the mesh is written as it was submitted, as OFF text, not as '" + extension +
                              "'; affskel-client transform --scale 1 writes it in other formats");
  }
}

Written fetch_divergence(Context& context, const Options& options, const Destination& destination) {
  const ChosenSkeleton chosen = choose_skeleton(context, options.job, options.skeleton);
  return transfer_divergence(context, chosen.job, chosen.get(), destination);
}

Written fetch_eroded(Context& context, const Options& options, const Destination& destination) {
  v1::ErodedParams params;
  params.set_fraction(wire::kErodedFraction);
  return holds_eroded_surface(destination)
             ? transfer_eroded_surface(context, options.job, params, destination)
             : transfer_eroded_points(context, options.job, params, destination);
}

// What can be fetched, in the order of the help.
struct Artifact {
  const char* name;
  Written (*fetch)(Context& context, const Options& options, const Destination& destination);
};

constexpr std::array<Artifact, 6> kArtifacts = {{
    {"field",
     [](Context& context, const Options& options, const Destination& destination) {
       return transfer_field(context, options.job, destination);
     }},
    {"divergence", fetch_divergence},
    {"skeleton",
     [](Context& context, const Options& options, const Destination& destination) {
       return transfer_skeleton(context, options.job, nullptr, destination);
     }},
    {"surface",
     [](Context& context, const Options& options, const Destination& destination) {
       return transfer_surface(context, options.job, nullptr, destination);
     }},
    {"eroded", fetch_eroded},
    {"mesh",
     [](Context& context, const Options& options, const Destination& destination) {
       warn_of_foreign_extension(context, destination);
       return transfer_mesh(context, options.job, destination);
     }},
}};

std::vector<std::string> artifact_names() {
  std::vector<std::string> names;
  for (const Artifact& artifact : kArtifacts) names.emplace_back(artifact.name);
  return names;
}

void run(Context& context, const Options& options) {
  const Destination destination = destination_of(options.output, options.format, context.console());
  // Other names do not pass the command line.
  const auto chosen = std::find_if(kArtifacts.begin(), kArtifacts.end(), [&](const Artifact& artifact) {
    return options.artifact == artifact.name;
  });
  tell_result(context.console(), chosen->fetch(context, options, destination));
}

// Options that only some artefacts have.
void check_options(const CLI::App& fetch) {
  const std::string artifact = fetch.get_option("ARTEFACT")->as<std::string>();
  if (fetch.count("--operator") > 0 && artifact != "divergence") {
    throw CLI::ValidationError("--operator", "is for the divergence; see skeleton --help");
  }
  if (fetch.count("--format") > 0 && artifact == "mesh") {
    throw CLI::ValidationError("--format", "the mesh is the submitted bytes; see transform --help");
  }
}

}  // namespace

void add_fetch(CommandLine& line) {
  const auto options = std::make_shared<Options>();
  CLI::App* command = line.add(
      "fetch", "Write one artefact of a job",
      "  affskel-client fetch @last field -o body.vtkhdf\n"
      "  affskel-client fetch @last skeleton -o body.csv\n"
      "  affskel-client fetch 3f2a9c mesh -o submitted.off\n"
      "  affskel-client fetch @last divergence --operator sobel -o H.csv\n"
      "  affskel-client fetch @last skeleton -o - --format csv | wc -l\n"
      "Formats by extension: field and divergence .csv .dat .vtkhdf;\n"
      "skeleton and eroded points .csv .ply .off .xyz .vtp; surface and eroded surface\n"
      ".off .ply .obj .stl .vtp; mesh: the submitted bytes. Of an eroded solid this\n"
      "is the one at a tenth of the volume; see erode",
      [options](Context& context) { run(context, *options); }, check_options);
  add_job(command, options->job);
  command->add_option("ARTEFACT", options->artifact, "What to fetch")
      ->required()
      ->check(CLI::IsMember(artifact_names()))
      ->type_name("");
  std::vector<std::string> with_divergence = operator_words();
  std::erase_if(with_divergence,
                [](const std::string& name) { return wire::gives_sheet(operator_named(name)); });
  command->add_option("--operator", options->skeleton.operator_name, "Of the divergence (default: the job's)")
      ->check(CLI::IsMember(with_divergence))
      ->type_name("OP");
  add_output(command, options->output, "File to write; the format follows the extension; - is stdout");
  add_format(command, options->format);
}

}  // namespace affskel::client
