#include "ruche/material/cards.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "ruche/cli/verbs.hpp"

namespace ruche {

static void list_cards() {
    for (const std::string& name : preset_names()) {
        const MaterialCard card = load_card(name);
        fmt::print("{}: {}\n", name, card.description);
        for (const CardSet& set : card.sets)
            fmt::print("  calibrated at a pre-stretch of {}\n", set.prestretch);
    }
    fmt::print("`ruche cards NAME` prints a card as a file to start your own from.\n");
}

void add_cards(CLI::App& program, Action& action) {
    const auto name = std::make_shared<std::string>();
    CLI::App* verb = program.add_subcommand("cards", "List the material cards, or print one");
    verb->add_option("name", *name, "Card to print, as a TOML file")->type_name("NAME");
    verb->callback([name, &action] {
        action = [name] {
            if (name->empty())
                list_cards();
            else
                fmt::print("{}", preset_text(*name));
            return ExitCode::converged;
        };
    });
}

}  // namespace ruche
