// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/expression.h"

#include <fmt/format.h>
#include <muParser.h>

#include "common/error.h"

namespace knead::tools {
namespace {

/// Position of a lone "=": muParser would take it as an assignment to x, y or z, which nobody means here.
std::size_t find_assignment(const std::string& text) {
    const std::string relational = "=<>!";
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '=') continue;
        const bool after = i > 0 && relational.find(text[i - 1]) != std::string::npos;
        const bool before = i + 1 < text.size() && text[i + 1] == '=';
        if (!after && !before) return i;
    }
    return std::string::npos;
}

[[noreturn]] void refuse(const std::string& expression, std::size_t position, const std::string& reason) {
    fail_usage(fmt::format("the expression \"{}\" cannot be read at character {}: {}", expression,
                           position + 1, reason));
}

}  // namespace

std::vector<double> evaluate_expression(const TetMesh& mesh, const std::string& expression) {
    const std::size_t assignment = find_assignment(expression);
    if (assignment != std::string::npos) refuse(expression, assignment, "a comparison is written ==");
    std::vector<double> values(mesh.tetrahedra.size());
    Point position{};
    try {
        mu::Parser parser;
        parser.DefineVar("x", &position[0]);
        parser.DefineVar("y", &position[1]);
        parser.DefineVar("z", &position[2]);
        parser.SetExpr(expression);
        for (std::size_t i = 0; i < values.size(); ++i) {
            position = barycentre_m(mesh, i);
            int results = 0;
            values[i] = parser.Eval(results)[0];
            if (results != 1) refuse(expression, 0, "it has several values, separated by commas");
        }
    } catch (const mu::Parser::exception_type& error) {
        const auto place = static_cast<std::size_t>(error.GetPos());  // out of range where there is none
        refuse(expression, place < expression.size() ? place : 0, error.GetMsg());
    }
    return values;
}

std::string expression_library() {
    return "muParser " + mu::Parser().GetVersion(mu::pviBRIEF);
}

}  // namespace knead::tools
