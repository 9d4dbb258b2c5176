// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/paper/files.h"

#include "common/error.h"
#include "evaluate/html_report.h"
#include "evaluate/installed_files.h"
#include "evaluate/tables.h"
#include "knead/formats/write/write.h"

namespace knead::tools {

PaperSummary write_paper(const std::filesystem::path& folder, const std::vector<SceneResult>& scenes,
                         const PaperRun& about) {
    const nlohmann::ordered_json published = papers_numbers();
    const PaperSummary summary = summarise_paper(scenes, published_paper(published));
    const std::vector<DocumentPart> document = paper_document(summary, about);
    nlohmann::ordered_json json = json_report(scenes, about.machine, about.commit, about.command);
    json["date"] = about.date;
    json["paper"] = published;
    json["paper_run"] = to_json(summary);
    const auto write = [&](const char* name, const std::string& text) {
        value_or_throw(write_text_file(folder / name, text));
    };
    write("paper.txt", as_text(document, false));
    write("paper.md", as_markdown(document));
    write("paper.json", json.dump() + "\n");
    if (const std::string page = page_template(); !page.empty()) write("paper.html", html_report(json, page));
    write("results.csv", csv_report(scenes));
    write("table1.csv", table1_csv(summary));
    write("table2.csv", table2_csv(summary));
    write("figure8.csv", figure8_csv(summary));
    return summary;
}

}  // namespace knead::tools
