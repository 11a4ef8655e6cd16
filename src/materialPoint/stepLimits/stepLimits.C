/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "stepLimits.H"
#include "DynamicList.H"
#include "Pstream.H"
#include "PstreamReduceOps.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::stepLimits::stepLimits(const scalar maxCo)
:
    maxCo_(maxCo),
    reduced_{false, false}
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::stepLimits::addMaximum
(
    const stage s,
    const value& ofRank,
    scalar& ofAll
)
{
    extremes_[s].push_back(extreme{ofRank, ofAll, 1});
}


void Foam::mpm::stepLimits::addMinimum
(
    const stage s,
    const value& ofRank,
    scalar& ofAll
)
{
    extremes_[s].push_back(extreme{ofRank, ofAll, -1});
}


void Foam::mpm::stepLimits::addSums
(
    const stage s,
    const values& ofRank,
    scalarList& ofAll
)
{
    sums_[s].push_back(sums{ofRank, ofAll});
}


void Foam::mpm::stepLimits::add(const word& name, const value& deltaT)
{
    limits_.push_back(limit{[name]() { return name; }, deltaT});
}


void Foam::mpm::stepLimits::add(const namer& name, const value& deltaT)
{
    limits_.push_back(limit{name, deltaT});
}


void Foam::mpm::stepLimits::reduce(const stage s)
{
    reduced_[s] = true;

    // The extremes, then the sums
    const std::vector<extreme>& extremes = extremes_[s];
    const label n = extremes.size();

    DynamicList<scalar> own(n);
    for (const extreme& e : extremes) own.append(e.sign*e.ofRank());
    for (const sums& sum : sums_[s])
    {
        sum.ofAll = sum.ofRank();
        own.append(sum.ofAll);
    }
    if (own.empty()) return;

    scalarList all(own);
    Foam::reduce
    (
        all,
        [n](const scalarList& a, const scalarList& b)
        {
            scalarList c(a.size());
            forAll(c, i) c[i] = i < n ? max(a[i], b[i]) : a[i] + b[i];
            return c;
        }
    );

    const scalar* value = all.cdata();
    for (const extreme& e : extremes) e.ofAll = e.sign*(*value++);
    for (const sums& sum : sums_[s])
    {
        for (scalar& v : sum.ofAll) v = *value++;
    }
}


Foam::scalar Foam::mpm::stepLimits::smallest(word& limiter) const
{
    scalar smallest = GREAT;
    limiter = "none";
    for (const limit& l : limits_)
    {
        const scalar deltaT = l.deltaT();
        if (deltaT < smallest)
        {
            smallest = deltaT;
            limiter = l.name();
        }
    }
    return smallest;
}

// ************************************************************************* //
