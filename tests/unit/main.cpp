#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cstdlib>

int main(int argc, char** argv) {
    // Property tests draw the same cases in every run, unless RC_PARAMS asks for others.
    setenv("RC_PARAMS", "seed=20221122", 0);
    return doctest::Context(argc, argv).run();
}
