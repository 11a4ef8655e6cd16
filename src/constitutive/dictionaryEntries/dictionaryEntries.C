/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "listed.H"
#include "dictionaryEntries.H"
#include "Switch.H"
#include "ITstream.H"
#include "stringOps.H"
#include <algorithm>
#include <cmath>
#include <sstream>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

//- Number of insertions, deletions, replacements and swaps of neighbours
//  between two words, whatever their case
Foam::label editDistance(const std::string& a, const std::string& b)
{
    using Foam::label;

    auto same = [&](const size_t i, const size_t j)
    {
        return std::tolower(a[i-1]) == std::tolower(b[j-1]);
    };
    std::vector<label> before(b.size() + 1), last(b.size() + 1);
    std::vector<label> row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j) row[j] = j;

    for (size_t i = 1; i <= a.size(); ++i)
    {
        before.swap(last);
        last.swap(row);
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j)
        {
            row[j] = std::min
            (
                last[j-1] + !same(i, j),
                1 + std::min(last[j], row[j-1])
            );
            if (i > 1 && j > 1 && same(i, j-1) && same(i-1, j))
            {
                row[j] = std::min(row[j], before[j-2] + 1);
            }
        }
    }
    return row[b.size()];
}


//- The one of some words that is nearest to a word, if nearer than a limit
const Foam::word* nearestOf
(
    const Foam::word& keyword,
    const Foam::wordList& known,
    const Foam::label limit
)
{
    const Foam::word* nearest = nullptr;
    Foam::label distance = limit;
    for (const Foam::word& candidate : known)
    {
        const Foam::label n = editDistance(keyword, candidate);
        if (n < distance)
        {
            distance = n;
            nearest = &candidate;
        }
    }
    return nearest;
}


//- A number, after its name and dimensions if these are given. By hand,
//  because dimensionedScalar aborts with a stack trace.
Foam::scalar readQuantity
(
    const Foam::dictionary& dict,
    const Foam::word& keyword,
    const Foam::dimensionSet& dims
)
{
    using namespace Foam;

    ITstream& is = dict.lookup(keyword);
    const string found(is.toString());

    token t;
    auto next = [&]()
    {
        if (is.eof() || is.nRemainingTokens() == 0) t = token();
        else is >> t;
    };
    next();
    if (t.isWord() && is.nRemainingTokens()) next();

    if (t.isPunctuation() && t.pToken() == token::BEGIN_SQR)
    {
        is.putBack(t);
        const dimensionSet given(is);
        if (given != dims)
        {
            FatalIOErrorInFunction(dict)
                << "keyword " << keyword << " has the dimensions " << given
                << '.' << nl << "    Allowed: " << dims << " or none"
                << exit(FatalIOError);
        }
        next();
    }
    if (!t.isNumber())
    {
        FatalIOErrorInFunction(dict)
            << "keyword " << keyword << " has the value " << found << '.' << nl
            << "    Allowed: a number, with the dimensions " << dims
            << " or none" << exit(FatalIOError);
    }
    if (is.nRemainingTokens())
    {
        FatalIOErrorInFunction(dict)
            << "keyword " << keyword << " has the value " << found
            << ", more than one number." << nl
            << "    Allowed: one number, with the dimensions " << dims
            << " or none" << exit(FatalIOError);
    }
    return t.number();
}


void checkBounds
(
    const Foam::dictionary& dict,
    const Foam::word& keyword,
    const Foam::scalar value,
    const Foam::scalar lower,
    const Foam::scalar upper,
    const bool lowerIncluded,
    const bool upperIncluded
)
{
    using namespace Foam;

    const bool above = lowerIncluded ? value >= lower : value > lower;
    const bool below = upperIncluded ? value <= upper : value < upper;

    if (!(above && below))
    {
        FatalIOErrorInFunction(dict)
            << "keyword " << keyword << " has the value " << value << '.'
            << nl << "    Allowed: ";
        if (lower > -GREAT)
        {
            FatalIOError<< lower << (lowerIncluded ? " <= " : " < ");
        }
        FatalIOError<< keyword;
        if (upper < GREAT || !below)
        {
            FatalIOError<< (upperIncluded ? " <= " : " < ") << upper;
        }
        FatalIOError<< exit(FatalIOError);
    }
}

} // End anonymous namespace


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::readBounded
(
    const dictionary& dict,
    const word& keyword,
    const dimensionSet& dims,
    const scalar lower,
    const scalar upper,
    const bool lowerIncluded,
    const bool upperIncluded
)
{
    const scalar value = readQuantity(dict, keyword, dims);
    checkBounds
    (
        dict, keyword, value, lower, upper, lowerIncluded, upperIncluded
    );
    return value;
}


Foam::scalar Foam::mpm::readBoundedOrDefault
(
    const dictionary& dict,
    const word& keyword,
    const dimensionSet& dims,
    const scalar defaultValue,
    const scalar lower,
    const scalar upper,
    const bool lowerIncluded,
    const bool upperIncluded
)
{
    if (!dict.found(keyword)) return defaultValue;

    return readBounded
    (
        dict, keyword, dims, lower, upper, lowerIncluded, upperIncluded
    );
}


Foam::scalar Foam::mpm::readPositive
(
    const dictionary& dict,
    const word& keyword,
    const dimensionSet& dims
)
{
    return readBounded(dict, keyword, dims, 0, GREAT);
}


Foam::label Foam::mpm::readInteger
(
    const dictionary& dict,
    const word& keyword,
    const label lower,
    const label upper
)
{
    const scalar value =
        readBounded(dict, keyword, dimless, lower, upper, true, true);
    if (value != std::floor(value))
    {
        FatalIOErrorInFunction(dict)
            << "keyword " << keyword << " has the value " << value << '.'
            << nl << "    Allowed: a whole number, " << lower << " <= "
            << keyword;
        if (upper < labelMax) FatalIOError<< " <= " << upper;
        FatalIOError<< exit(FatalIOError);
    }
    return label(value);
}


Foam::label Foam::mpm::readIntegerOrDefault
(
    const dictionary& dict,
    const word& keyword,
    const label defaultValue,
    const label lower,
    const label upper
)
{
    return
        dict.found(keyword)
      ? readInteger(dict, keyword, lower, upper)
      : defaultValue;
}


int64_t Foam::mpm::readCount(const dictionary& dict, const word& keyword)
{
    // Above the largest label a number is read as a scalar, exact to 2^53
    const scalar most = scalar(int64_t(1) << 53);
    const scalar value =
        readBounded(dict, keyword, dimless, 0, most, true, true);
    if (value != std::floor(value))
    {
        FatalIOErrorInFunction(dict)
            << "keyword " << keyword << " has the value " << value << '.'
            << nl << "    Allowed: a whole number >= 0" << exit(FatalIOError);
    }
    return int64_t(value);
}


int64_t Foam::mpm::readCountOrZero
(
    const dictionary& dict,
    const word& keyword
)
{
    return dict.found(keyword) ? readCount(dict, keyword) : 0;
}


void Foam::mpm::warnUnusual
(
    const dictionary& dict,
    const std::initializer_list<usualRange>& ranges
)
{
    for (const usualRange& range : ranges)
    {
        const word keyword(range.keyword);
        if (!dict.found(keyword)) continue;

        // Its dimensions were checked where it was read
        const ITstream& is = dict.lookup(keyword);
        if (is.empty() || !is.last().isNumber()) continue;
        const scalar value = is.last().number();
        if (value >= range.lower && value <= range.upper) continue;

        OSstream& os = IOWarningInFunction(dict);
        os  << "keyword " << keyword << " has the value " << value << '.'
            << nl << "    Usual (" << range.source << "): " << range.lower << " <= " << keyword;
        if (range.upper < GREAT) os << " <= " << range.upper;
        os  << nl << endl;
    }
}


const Foam::dictionary& Foam::mpm::subDictOf
(
    const dictionary& dict,
    const word& keyword
)
{
    const entry* e = dict.findEntry(keyword, keyType::REGEX);
    if (!e)
    {
        FatalIOErrorInFunction(dict)
            << "keyword " << keyword << " is missing in dictionary "
            << dict.name() << '.' << nl << "    Allowed: a dictionary, "
            << keyword << " { ... }" << exit(FatalIOError);
    }
    if (!e->isDict())
    {
        FatalIOErrorInFunction(dict)
            << "keyword " << keyword << " has the value "
            << e->stream().toString().c_str() << ", which is not a dictionary." << nl
            << "    Allowed: a dictionary, " << keyword << " { ... }"
            << exit(FatalIOError);
    }
    return e->dict();
}


Foam::dictionary Foam::mpm::subDictOrEmpty
(
    const dictionary& dict,
    const word& keyword
)
{
    // What is missing is OpenFOAM's, which names it in messages
    return
        dict.found(keyword, keyType::REGEX)
      ? subDictOf(dict, keyword)
      : dict.subOrEmptyDict(keyword);
}


bool Foam::mpm::readSwitchOrDefault
(
    const dictionary& dict,
    const word& keyword,
    const bool defaultValue
)
{
    if (!dict.found(keyword)) return defaultValue;

    const word value(dict.get<word>(keyword));
    const Switch result(value, true);

    if (!result.valid())
    {
        FatalIOErrorInFunction(dict)
            << "keyword " << keyword << " has the value " << value << '.' << nl
            << "    Allowed: yes, no" << exit(FatalIOError);
    }
    return result;
}


Foam::word Foam::mpm::readChoice
(
    const dictionary& dict,
    const word& keyword,
    const wordList& allowed
)
{
    const word value(dict.get<word>(keyword));

    if (!allowed.found(value))
    {
        FatalIOErrorInFunction(dict)
            << "keyword " << keyword << ": unknown " << keyword << ' '
            << value << nl << "    Valid names: " << listed(allowed)
            << exit(FatalIOError);
    }
    return value;
}


Foam::word Foam::mpm::readChoiceOrDefault
(
    const dictionary& dict,
    const word& keyword,
    const word& defaultValue,
    const wordList& allowed
)
{
    return
        dict.found(keyword)
      ? readChoice(dict, keyword, allowed)
      : defaultValue;
}


void Foam::mpm::reportEntry
(
    const dictionary& dict,
    const string& message,
    const bool strict
)
{
    if (strict)
    {
        FatalIOErrorInFunction(dict)
            << message.c_str() << nl << "    (strictKeywords no; in the"
            << " sub-dictionary MPM of system/fvSolution turns this into"
            << " a warning)" << exit(FatalIOError);
    }
    else
    {
        IOWarningInFunction(dict) << message.c_str() << nl << endl;
    }
}


void Foam::mpm::checkKeywords
(
    const dictionary& dict,
    const wordList& known,
    const bool strict
)
{
    for (const entry& e : dict)
    {
        const word& keyword = e.keyword();
        if (e.keyword().isPattern() || known.found(keyword)) continue;

        std::ostringstream message;
        message
            << "unknown keyword " << keyword << " in dictionary "
            << dict.name() << " line " << e.startLineNumber() << ".\n    ";

        const word* nearest = nearestOf
        (
            keyword, known, max(label(2), label(keyword.size()/3)) + 1
        );
        if (nearest) message << "Did you mean " << *nearest << "? ";
        message << "Known keywords: ";
        for (const word& candidate : known) message << candidate << ' ';

        reportEntry(dict, message.str(), strict);
    }
}


void Foam::mpm::checkNearMisses
(
    const dictionary& dict,
    const wordList& known,
    const wordList& ofOthers,
    const bool strict
)
{
    for (const entry& e : dict)
    {
        const word& keyword = e.keyword();
        if
        (
            e.keyword().isPattern()
         || known.found(keyword) || ofOthers.found(keyword)
        )
        {
            continue;
        }

        // Short words are near to many others
        const word* nearest =
            nearestOf(keyword, known, keyword.size() < 8 ? 2 : 3);
        if (!nearest) continue;

        std::ostringstream message;
        message
            << "unknown keyword " << keyword << " in dictionary "
            << dict.name() << " is not used.\n    Did you mean " << *nearest << '?';

        // Beside the right one it may be somebody's own, for $macros
        reportEntry(dict, message.str(), strict && !dict.found(*nearest));
    }
}

// ************************************************************************* //
