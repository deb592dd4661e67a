// Render farms: the very script and command lines that the README shows, under the real schedulers.
#include "cli/workplace.h"

namespace {

const std::string tests = VOXREF_SOURCE_DIR "/tests/cli/", tools = VOXREF_SOURCE_DIR "/tools/";
// Some seconds of work per part, so that there is time to interrupt it; checkpoints much more often than that.
const std::string render = " --spp 8192 --size 80x60 --checkpoint 0.05 ";

bool installed(const Workplace& place, const std::string& programs) {
  for (std::istringstream names(programs); names;) {
    std::string name;
    if (names >> name && place.shell("PATH=$PATH:/usr/sbin command -v " + name).status != 0) return false;
  }
  return true;
}

/// The same pixels; of the header, only who made it and the parts' own record may differ.
void check_is_one_render(const Workplace& place, const std::string& joined) {
  REQUIRE(place.run("path point.glb -o one.exr --quiet" + render).status == 0);
  voxref::Image a = voxref::read_image(place.path(joined)), b = voxref::read_image(place.path("one.exr"));
  check_same_bits(a, b);
  CHECK(a.attributes.erase("voxref:render") == 1);
  CHECK(contains(a.attributes["voxref:command_line"], "merge"));
  for (const std::string differs : {"voxref:command_line", "DateTime"}) {
    a.attributes.erase(differs);
    b.attributes.erase(differs);
  }
  CHECK(a.attributes == b.attributes);
}

/// Programs whose environment names the folder of this test: all that it started and that still run.
std::string still_running(const Workplace& place) {
  std::string found;
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc")) {
    const std::string id = entry.path().filename().string();
    if (id.find_first_not_of("0123456789") != std::string::npos || id == std::to_string(::getpid())) continue;
    std::ifstream environment(entry.path() / "environ", std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(environment), {});
    if (contains(text, "FARM_TEST=" + place.path("").string())) found += id + " ";
  }
  return found;
}

}  // namespace

TEST_CASE("a Slurm job array, one task requeued half-way, joins to the bits of one render", "[farm]") {
  const Workplace place;
  if (!installed(place, "slurmctld slurmd munged sbatch")) VOXREF_SKIP("slurm is not installed");
  // Slurm lets a requeued task wait for two minutes, unless told otherwise.
  voxref::write_text(place.path("farm.sh"), R"(
set -e
job=$(sbatch --parsable --array=1-3 ')" + tools +
                                                R"(farm.sbatch' 3 point.glb whole.exr)" + render + R"()
until [ -e whole.part1.exr.checkpoint ] || [ -e whole.part1.exr ]; do sleep 0.05; done
scontrol requeue ${job}_1
until scontrol show job ${job}_1 | grep -q JobState=PENDING; do sleep 0.1; done
scontrol update jobid=${job}_1 starttime=now
sbatch --wait --dependency=afterok:$job --output=merge.log --wrap 'voxref merge whole.part*.exr -o whole.exr'
scontrol --oneliner show job ${job}_1 | grep -o 'Restarts=[0-9]*'
)");
  // The limit is for a scheduler that hangs, and below that of CTest, after which nobody would stop it.
  const Outcome outcome =
      place.shell("FARM_TEST='" + place.path("").string() + "' timeout 280 '" + tests + "with_slurm' sh farm.sh");
  INFO(outcome.out << outcome.err << place.shell("tail -n 50 *.log").out);
  REQUIRE(outcome.status == 0);
  CHECK(contains(outcome.out, "Restarts=1"));
  CHECK(still_running(place) == "");
  check_is_one_render(place, "whole.exr");
  // Nothing is left but scene, parts, image and logs.
  for (const std::string& file : place.files()) {
    CAPTURE(file);
    CHECK(!contains(file, "checkpoint"));
    CHECK(fs::path(file).filename().string().front() != '.');
  }
}

TEST_CASE("a cluster for one command ends with it, and with whoever stops it", "[farm]") {
  const Workplace place;
  if (!installed(place, "slurmctld slurmd munged sbatch")) VOXREF_SKIP("slurm is not installed");
  const std::string cluster = "FARM_TEST='" + place.path("").string() + "' timeout ";
  const std::string endless = "with_slurm' sh -c 'sbatch --output=/dev/null --wrap \"sleep 1000\"; ";
  CHECK(place.shell(cluster + "100 '" + tests + endless + "exit 7'").status == 7);
  // Enough for the cluster to be up; where it is not, the daemons under way must end as well.
  CHECK(place.shell(cluster + "6 '" + tests + endless + "sleep 1000'").status == 124);
  CHECK(still_running(place) == "");
}

TEST_CASE("GNU parallel retries a part that was killed, and all join to the bits of one render", "[farm]") {
  const Workplace place;
  if (!installed(place, "parallel")) VOXREF_SKIP("parallel is not installed");
  // A voxref whose first run is killed half-way.
  fs::create_directory(place.path("mortal"));
  voxref::write_text(place.path("mortal/voxref"), R"(#!/bin/sh
mkdir killed 2>/dev/null || exec ')" VOXREF_PROGRAM R"(' "$@"
timeout -s KILL 1 ')" VOXREF_PROGRAM R"(' "$@"
echo $? >killed/status
exit $(cat killed/status)
)");
  fs::permissions(place.path("mortal/voxref"), fs::perms::owner_all);
  const Outcome outcome = place.shell(
      "PATH=\"$PWD/mortal:$PATH\" && "
      "seq 3 | parallel --retries 3 voxref path point.glb -o part{}.exr --part {}/3 --resume --quiet" +
      render + "&& voxref merge part*.exr -o whole.exr");
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.status == 0);
  CHECK(place.shell("cat killed/status").out == "137\n");  // killed, and not finished before
  check_is_one_render(place, "whole.exr");
  CHECK(place.shell("ls -A *.checkpoint .[!.]*").out == "");
}
