// SPDX-License-Identifier: Apache-2.0
// write_report EVALUATION TEMPLATE PAGE: the page of an evaluation, by the same function as knead-evaluate's.
#include <fstream>
#include <iostream>
#include <sstream>

#include "evaluate/html_report.h"

int main(int argc, char** argv) {
    if (argc != 4) {
        std::cerr << "usage: write_report EVALUATION TEMPLATE PAGE\n";
        return 2;
    }
    std::ifstream evaluation(argv[1]), page(argv[2]);
    std::stringstream text;
    text << page.rdbuf();
    std::ofstream output(argv[3], std::ios::binary);
    output << knead::tools::html_report(nlohmann::json::parse(evaluation), text.str());
    return output.flush() ? 0 : 1;
}
