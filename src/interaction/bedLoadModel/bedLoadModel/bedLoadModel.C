/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "bedLoadModel.H"
#include "dictionaryEntries.H"
#include "listed.H"
#include <cmath>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(bedLoadModel, 0);
    defineRunTimeSelectionTable(bedLoadModel, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::bedLoadModel::bedLoadModel
(
    const dictionary& coeffs,
    const bed& b,
    const scalar criticalShields,
    const scalar coefficient
)
:
    bed_(b),
    criticalShields_
    (
        readBoundedOrDefault
        (
            coeffs, "criticalShields", dimless, criticalShields, 0, 1
        )
    ),
    averagingTime_
    (
        readBoundedOrDefault
        (
            coeffs, "averagingTime", dimTime,
            20*b.d/std::sqrt(criticalShields_*(b.rhoS/b.rho - 1)*b.g*b.d),
            0, GREAT
        )
    ),
    coefficient_(coefficient)
{}


// * * * * * * * * * * * * * * * * Selector  * * * * * * * * * * * * * * * * //

Foam::autoPtr<Foam::mpm::bedLoadModel> Foam::mpm::bedLoadModel::New
(
    const dictionary& soilDict,
    const bed& b,
    const bool strictKeywords
)
{
    const word name(soilDict.lookupOrDefault<word>("bedLoad", "none"));

    auto found = dictionaryConstructorTablePtr_->cfind(name);
    if (!found.found())
    {
        FatalIOErrorInFunction(soilDict)
            << "keyword bedLoad: unknown model " << name << nl
            << "    Valid names: "
            << listed(dictionaryConstructorTablePtr_->sortedToc())
            << exit(FatalIOError);
    }
    const dictionary coeffs(subDictOrEmpty(soilDict, name + "Coeffs"));
    checkKeywords
    (
        coeffs, {"criticalShields", "averagingTime"}, strictKeywords
    );
    return found()(coeffs, b);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::bedLoadModel::transportScale() const
{
    return std::sqrt((bed_.rhoS/bed_.rho - 1)*bed_.g*pow3(bed_.d));
}


Foam::scalar Foam::mpm::bedLoadModel::slopeFactor
(
    const scalar along,
    const scalar sineSqr,
    const scalar cosine,
    const scalar mu
)
{
    const scalar a = along/mu;
    const scalar root = sqr(cosine) - sineSqr/sqr(mu) + sqr(a);
    return root > 0 ? max(std::sqrt(root) - a, scalar(0)) : 0;
}


Foam::scalar Foam::mpm::bedLoadModel::unresolved(const scalar stress) const
{
    return min(max(2 - stress/bed_.rowStress(), scalar(0)), scalar(1));
}


void Foam::mpm::bedLoadModel::transport
(
    const label n,
    const scalar* shields,
    const scalar* critical,
    scalar* q
) const
{
    for (label i = 0; i < n; ++i)
    {
        const scalar excess = max(shields[i] - critical[i], scalar(0));
        q[i] = coefficient_*excess*std::sqrt(excess);
    }
}


void Foam::mpm::bedLoadModel::velocity
(
    const label n,
    const scalar* const* stress,
    const scalar* const* normal,
    const scalar* perThickness,
    scalar* const* velocity
) const
{
    const label dim = bed_.nDim;
    const scalar perStress = 1/(bed_.weight()*bed_.d);

    scalar shields[blockSize], critical[blockSize], q[blockSize];
    nodeVector direction[blockSize];

    for (label begin = 0; begin < n; begin += blockSize)
    {
        const label size = min(n - begin, blockSize);
        for (label i = 0; i < size; ++i)
        {
            const label p = begin + i;

            // Normals of unit length, where they have been averaged, too
            nodeVector tau{}, up{};
            scalar lengthSqr = 0;
            for (label d = 0; d < dim; ++d)
            {
                tau[d] = stress[d][p];
                up[d] = normal[d][p];
                lengthSqr += sqr(up[d]);
            }
            up *= 1/std::sqrt(max(lengthSqr, VSMALL));

            scalar cosine = 0, into = 0;
            for (label d = 0; d < dim; ++d)
            {
                cosine -= bed_.down[d]*up[d];
                into += tau[d]*up[d];
            }
            const nodeVector slope = bed_.down + cosine*up;
            tau -= into*up;

            scalar tauSqr = 0, sineSqr = 0, along = 0;
            for (label d = 0; d < dim; ++d)
            {
                tauSqr += sqr(tau[d]);
                sineSqr += sqr(slope[d]);
                along += tau[d]*slope[d];
            }
            const scalar size = std::sqrt(tauSqr);
            if (size > 0) along /= size;

            shields[i] = size*perStress;
            critical[i] =
                criticalShields_
               *slopeFactor(along, sineSqr, max(cosine, scalar(0)), bed_.mu);

            nodeVector way =
                perStress*tau + (criticalShields_/bed_.mu)*slope;
            scalar waySqr = 0;
            for (label d = 0; d < dim; ++d) waySqr += sqr(way[d]);
            direction[i] = way*(1/std::sqrt(max(waySqr, VSMALL)));
            direction[i] *= unresolved(size);
        }
        transport(size, shields, critical, q);

        // A layer is at least a grain thick
        const scalar most = 1/(bed_.solidFraction*bed_.d);
        for (label i = 0; i < size; ++i)
        {
            const scalar speed =
                q[i]*transportScale()*min(perThickness[begin + i], most);
            for (label d = 0; d < dim; ++d)
            {
                velocity[d][begin + i] = speed*direction[i][d];
            }
        }
    }
}

// ************************************************************************* //
