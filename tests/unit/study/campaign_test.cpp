#include "ruche/study/calibration/campaign.hpp"

#include <doctest/doctest.h>

#include <string>

#include "ruche/core/document.hpp"

using namespace ruche;

namespace {

const std::string docs = RUCHE_TEST_DATA "/../../docs/";

std::string file_text(const std::string& path) { return read_file(path, "page", 1U << 20U); }

}  // namespace

TEST_CASE("docs: the committed page of the campaign file is the generated one") {
    CHECK(file_text(docs + "campaign.md") == campaign_manual());
}

TEST_CASE("docs: the campaign in the manual is one, and says what it seems to say") {
    const std::string page = file_text(docs + "calibration.md");
    const std::string fence = "```toml\n";
    const std::size_t begin = page.find(fence) + fence.size();
    const Campaign campaign =
        parse_campaign(page.substr(begin, page.find("```\n", begin) - begin), "c/campaign.toml");
    CHECK(campaign.fabric.thickness_mm.size() == 2);
    CHECK(campaign.tension.at(0).file == "c/raw/00.csv");
    CHECK(campaign.tension.at(0).columns.force == "Channel 3");
    CHECK(campaign.tension.at(0).specimen == 2);
    CHECK(campaign.cantilever.at(0).y_mm.size() == 3);
    CHECK(campaign.printed.at(0).prestretch == 1.7);
}
