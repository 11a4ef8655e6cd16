/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "FlatOutput.H"
#include "dictionaryEntries.H"
#include "Switch.H"
#include "ITstream.H"
#include "stringOps.H"
#include <algorithm>
#include <sstream>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

//- Number of insertions, deletions and replacements between two words
Foam::label editDistance(const std::string& a, const std::string& b)
{
    std::vector<Foam::label> row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j) row[j] = j;

    for (size_t i = 1; i <= a.size(); ++i)
    {
        Foam::label diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j)
        {
            const Foam::label above = row[j];
            row[j] = std::min
            (
                diagonal + (std::tolower(a[i-1]) != std::tolower(b[j-1])),
                1 + std::min(above, row[j-1])
            );
            diagonal = above;
        }
    }
    return row[b.size()];
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
        if (upper < GREAT)
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


void Foam::mpm::warnOutside
(
    const dictionary& dict,
    const word& keyword,
    const scalar value,
    const scalar lower,
    const scalar upper,
    const string& source
)
{
    if (value >= lower && value <= upper) return;

    IOWarningInFunction(dict)
        << "keyword " << keyword << " has the value " << value << '.' << nl
        << "    Usual, from " << source.c_str() << ": " << lower << " <= "
        << keyword << " <= " << upper << endl;
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
            << value << nl << "    Valid names: " << flatOutput(allowed)
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

        const word* nearest = nullptr;
        label distance = max(label(2), label(keyword.size()/3)) + 1;
        for (const word& candidate : known)
        {
            const label n = editDistance(keyword, candidate);
            if (n < distance)
            {
                distance = n;
                nearest = &candidate;
            }
        }
        if (nearest) message << "Did you mean " << *nearest << "? ";
        message << "Known keywords: ";
        for (const word& candidate : known) message << candidate << ' ';

        if (strict)
        {
            FatalIOErrorInFunction(dict)
                << message.str().c_str() << nl << "    (strictKeywords no; in the"
                << " sub-dictionary MPM of system/fvSolution turns this into"
                << " a warning)" << exit(FatalIOError);
        }
        else
        {
            IOWarningInFunction(dict) << message.str().c_str() << endl;
        }
    }
}

// ************************************************************************* //
