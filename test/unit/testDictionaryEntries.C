/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "dictionaryEntries.H"
#include "StringStream.H"
#include "IFstream.H"
#include "testMesh.H"
#include <fstream>

using namespace Foam;
using namespace Foam::mpm;

namespace
{

dictionary dictOf(const std::string& text)
{
    IStringStream is
    (
        text, IOstream::ASCII, IOstream::currentVersion, "constant/properties"
    );
    return dictionary(is);
}

//- The error and the file it names
std::string errorIn(const std::function<void()>& op)
{
    try
    {
        op();
    }
    catch (const IOerror& e)
    {
        return e.message() + " file: " + e.ioFileName();
    }
    catch (const error& e)
    {
        return "an error without file: " + e.message();
    }
    FAIL("no error was raised");
    return "";
}

} // End anonymous namespace


TEST_CASE("dictionaryEntries: whole numbers")
{
    const dictionary dict
    (
        dictOf("n 3; real 3.0; broken 2.5; text many; count 3000000000;")
    );
    equal("n", readInteger(dict, "n", 1, 5), 3);
    equal("3.0", readInteger(dict, "real", 1), 3);
    equal("default", readIntegerOrDefault(dict, "none", 7, 1, 5), 7);
    equal
    (
        "more than a label of 32 bits holds",
        std::to_string(readCount(dict, "count")), "3000000000"
    );
    equal("not there", label(readCountOrZero(dict, "none")), 0);

    const std::vector<std::string> broken
        ({"broken", "2.5", "whole number", "constant/properties"});
    contains(errorIn([&] { readInteger(dict, "broken", 1, 5); }), broken);
    contains(errorIn([&] { readIntegerOrDefault(dict, "broken", 1, 1); }), broken);
    contains(errorIn([&] { readCount(dict, "broken"); }), broken);
    contains
    (
        errorIn([&] { readInteger(dict, "n", 4, 5); }),
        {"keyword n", "3", "4 <= n <= 5"}
    );
    contains(errorIn([&] { readInteger(dict, "text", 1); }), {"text", "many"});
    contains(errorIn([&] { readInteger(dict, "count", 1); }), {"count"});
}


TEST_CASE("dictionaryEntries: values with and without dimensions")
{
    const dictionary dict
    (
        dictOf
        (
            "plain 1000; full rho [1 -3 0 0 0 0 0] 1001;"
            " nameless [1 -3 0 0 0 0 0] 1002; wrong [0 1 -1 0 0 0 0] 1003;"
        )
    );
    atMost("plain", mag(readPositive(dict, "plain", dimDensity) - 1000), 0);
    atMost
    (
        "name, dimensions", mag(readPositive(dict, "full", dimDensity) - 1001),
        0
    );
    atMost
    (
        "dimensions", mag(readPositive(dict, "nameless", dimDensity) - 1002), 0
    );

    contains
    (
        errorIn([&]() { readPositive(dict, "wrong", dimDensity); }),
        {"wrong", "[0 1 -1 0 0 0 0]", "[1 -3 0 0 0 0 0]", "constant/properties"}
    );
}


TEST_CASE("dictionaryEntries: bounds")
{
    const dictionary dict
    (
        dictOf("low -1; zero 0; middle 0.3; one 1; high 2.5;")
    );
    auto read = [&](const word& keyword, const bool lower, const bool upper)
    {
        return readBounded(dict, keyword, dimless, 0, 1, lower, upper);
    };

    atMost("inside", mag(read("middle", false, false) - 0.3), 0);
    atMost("lower bound included", mag(read("zero", true, false)), 0);
    atMost("upper bound included", mag(read("one", false, true) - 1), 0);

    const std::string file("constant/properties");
    contains
    (
        errorIn([&]() { read("low", true, true); }),
        {"keyword low", "-1", "0 <= low <= 1", file}
    );
    contains
    (
        errorIn([&]() { read("high", false, true); }),
        {"keyword high", "2.5", "0 < high <= 1", file}
    );
    contains
    (
        errorIn([&]() { read("zero", false, true); }),
        {"keyword zero", "0 < zero <= 1"}
    );
    contains
    (
        errorIn([&]() { read("one", true, false); }),
        {"keyword one", "0 <= one < 1"}
    );
    contains
    (
        errorIn([&]() { readPositive(dict, "low", dimless); }),
        {"keyword low", "-1", "0 < low"}
    );
    contains
    (
        errorIn([&]() { readPositive(dict, "absent", dimless); }),
        {"absent", file}
    );
}


TEST_CASE("dictionaryEntries: values that are no numbers")
{
    const dictionary dict
    (
        dictOf
        (
            "heavy much; unset nan; list (1 2); empty; text \"1000\";"
            " half rho [1 -3 0 0 0 0 0];"
        )
    );
    auto refusal = [&](const word& keyword)
    {
        return errorIn([&]() { readPositive(dict, keyword, dimDensity); });
    };
    const std::string file("constant/properties");
    contains
    (
        refusal("heavy"), {"keyword heavy", "much", "Allowed: a number", file}
    );
    contains
    (
        refusal("unset"), {"keyword unset", "nan", "Allowed: a number", file}
    );
    contains
    (
        refusal("list"), {"keyword list", "1 2", "Allowed: a number", file}
    );
    contains(refusal("empty"), {"keyword empty", "Allowed: a number", file});
    contains
    (
        refusal("text"), {"keyword text", "1000", "Allowed: a number", file}
    );
    contains
    (
        refusal("half"),
        {"keyword half", "[1 -3 0 0 0 0 0]", "Allowed: a number", file}
    );
}


TEST_CASE("dictionaryEntries: switches")
{
    const dictionary dict(dictOf("a yes; b off; c true; d maybe;"));
    equal("yes", label(readSwitchOrDefault(dict, "a", false)), 1);
    equal("off", label(readSwitchOrDefault(dict, "b", true)), 0);
    equal("true", label(readSwitchOrDefault(dict, "c", false)), 1);
    equal("default", label(readSwitchOrDefault(dict, "absent", true)), 1);
    contains
    (
        errorIn([&]() { readSwitchOrDefault(dict, "d", true); }),
        {"keyword d", "maybe", "Allowed: yes, no", "constant/properties"}
    );
}


TEST_CASE("dictionaryEntries: defaults")
{
    const dictionary dict(dictOf("given 3; bad 30;"));
    atMost
    (
        "default",
        mag(readBoundedOrDefault(dict, "absent", dimless, 7, 0, 10) - 7), 0
    );
    atMost
    (
        "given",
        mag(readBoundedOrDefault(dict, "given", dimless, 7, 0, 10) - 3), 0
    );
    contains
    (
        errorIn
        (
            [&]() { readBoundedOrDefault(dict, "bad", dimless, 7, 0, 10); }
        ),
        {"keyword bad", "30", "0 < bad < 10"}
    );
}


TEST_CASE("dictionaryEntries: choices")
{
    const dictionary dict(dictOf("transfer FLIP; scheme flipp;"));
    const wordList allowed({"APIC", "FLIP", "PIC"});

    equal("given", readChoice(dict, "transfer", allowed), "FLIP");
    equal
    (
        "default", readChoiceOrDefault(dict, "absent", "APIC", allowed), "APIC"
    );
    contains
    (
        errorIn([&]() { readChoice(dict, "scheme", allowed); }),
        {
            "keyword scheme", "flipp", "APIC", "FLIP", "PIC",
            "constant/properties"
        }
    );
    contains
    (
        errorIn([&]() { readChoice(dict, "absent", allowed); }), {"absent"}
    );
}


TEST_CASE("dictionaryEntries: misspelt keywords")
{
    const wordList known
    ({
        "shapeFunction", "maxCo", "sortInterval", "smoothing"
    });

    checkKeywords(dictOf("maxCo 0.5; smoothing no;"), known, true);

    // Lines count in files
    const temporaryDirectory directory;
    const fileName path(directory.path/"fvSolution");
    std::ofstream(path) << "maxCo 0.5;\nsmothing no;\n";
    IFstream is(path);
    const dictionary misspelt(is);
    contains
    (
        errorIn([&]() { checkKeywords(misspelt, known, true); }),
        {"smothing", "line 2", "Did you mean smoothing?", "shapeFunction", path}
    );
    contains
    (
        errorIn
        (
            [&]()
            {
                checkKeywords(dictOf("ShapeFunctoin linear;"), known, true);
            }
        ),
        {"ShapeFunctoin", "Did you mean shapeFunction?"}
    );

    // Nothing is near
    const std::string far
    (
        errorIn([&]() { checkKeywords(dictOf("turbulence on;"), known, true); })
    );
    contains(far, {"turbulence", "Known keywords: shapeFunction"});
    equal
    (
        "suggestions for a word that is far from all",
        label(far.find("Did you mean") != std::string::npos), 0
    );

    // A warning only
    bool raised = false;
    try
    {
        checkKeywords(dictOf("smothing no;"), known, false);
    }
    catch (const error&)
    {
        raised = true;
    }
    equal("errors when not strict", label(raised), 0);
}

// ************************************************************************* //
