// make_seeds FOLDER: writes the seeds of every target to FOLDER/<target>/.
#include "runtime/file.h"
#include "tests/fuzz/seeds.h"
#include "tests/fuzz/targets.h"

#include <cstdio>

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::fprintf(stderr, "usage: make_seeds FOLDER\n");
        return 2;
    }
    for (const penumbra::FuzzTarget& target : penumbra::kFuzzTargets)
        for (const penumbra::FuzzSeed& seed : penumbra::fuzzSeeds(target.name)) {
            const auto path = std::filesystem::path(argv[1]) / target.name / seed.name;
            const auto written = penumbra::writeFile(path, std::span<const std::byte>(seed.bytes));
            if (!written) {
                std::fprintf(stderr, "make_seeds: %s\n", written.error().message.c_str());
                return 1;
            }
        }
    return 0;
}
