/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "pressureSet.H"
#include "bodies.H"
#include "dictionaryEntries.H"
#include "listed.H"
#include <algorithm>
#include <unordered_map>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{
    using namespace Foam;

    //- Takes the field p of those that a cloud offers
    struct takePressure
    {
        scalarField& p;

        void keep(const scalarField& values) const { p = values; }

        template<class Type>
        void keep(const Field<Type>&) const {}

        template<class Values>
        void operator()(const word& name, const Values& values) const
        {
            if (name == "p") keep(values()());
        }
    };
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::pointField Foam::mpm::pressureSet::faceCentres
(
    const fvMesh& mesh,
    const dictionary& dict
)
{
    const word patch(dict.get<word>("patch"));
    const label patchi = mesh.boundaryMesh().findPatchID(patch);
    if (patchi < 0)
    {
        FatalIOErrorInFunction(dict)
            << "keyword patch: there is no patch " << patch << '.' << nl
            << "    Allowed: " << listed(mesh.boundaryMesh().names())
            << exit(FatalIOError);
    }
    List<pointField> ofRank(Pstream::nProcs());
    ofRank[Pstream::myProcNo()] = mesh.boundaryMesh()[patchi].faceCentres();
    Pstream::gatherList(ofRank);
    Pstream::scatterList(ofRank);

    std::vector<point> all;
    for (const pointField& f : ofRank) all.insert(all.end(), f.begin(), f.end());
    std::sort
    (
        all.begin(),
        all.end(),
        [](const point& a, const point& b)
        {
            for (direction d = 0; d < 3; ++d)
            {
                if (mag(a[d] - b[d]) > SMALL*(1 + mag(a[d]))) return a[d] < b[d];
            }
            return false;
        }
    );
    pointField places(label(all.size()));
    std::copy(all.begin(), all.end(), places.begin());
    return places;
}


void Foam::mpm::pressureSet::moveToSurface
(
    const dictionary& dict,
    const scalar length
)
{
    const bodyMotion& motion = body_->motion();
    for (point& X : places_)
    {
        point x(motion.fromSurface(X));
        for (label i = 0; i < 3; ++i)
        {
            const scalar phi = body_->distance(x);
            if (!(mag(phi) < 0.5*GREAT))
            {
                FatalIOErrorInFunction(dict)
                    << "pressure set " << name_ << ": the place " << X
                    << " is not near the surface of body " << body_->name()
                    << '.' << nl << "    Allowed: within three cells of it"
                    << exit(FatalIOError);
            }
            const vector n(body_->gradient(x, length));
            if (!(mag(n) > SMALL)) break;
            x -= phi*n/mag(n);
        }
        X = motion.toSurface(x);
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::pressureSet::pressureSet
(
    const word& name,
    const dictionary& dict,
    const materialPointCloud& cloud,
    const fvMesh& mesh,
    const bool strict
)
:
    name_(name),
    body_(nullptr)
{
    const word type(readChoice(dict, "type", {"points", "line", "patch"}));
    wordList known({"type", "body"});
    if (type == "points") known.append("points");
    else if (type == "line") known.append(wordList({"start", "end", "nPoints"}));
    else known.append("patch");
    checkKeywords(dict, known, strict);

    if (type == "points") places_ = dict.get<pointField>("points");
    else if (type == "line")
    {
        const point start(dict.get<point>("start"));
        const point end(dict.get<point>("end"));
        const label n = readInteger(dict, "nPoints", 2, maxPlaces);
        places_.setSize(n);
        forAll(places_, i)
        {
            places_[i] = start + scalar(i)/(n - 1)*(end - start);
        }
    }
    else places_ = faceCentres(mesh, dict);

    if (places_.empty() || places_.size() > maxPlaces)
    {
        FatalIOErrorInFunction(dict)
            << "pressure set " << name_ << " has " << places_.size()
            << " places." << nl << "    Allowed: 1 to " << maxPlaces
            << exit(FatalIOError);
    }

    if (dict.found("body"))
    {
        const word wanted(dict.get<word>("body"));
        wordList names;
        const bodies* all = cloud.bodiesPtr();
        for (label b = 0; all && b < all->size(); ++b)
        {
            names.append((*all)[b].name());
            if (names.last() == wanted) body_ = &(*all)[b];
        }
        if (!body_)
        {
            FatalIOErrorInFunction(dict)
                << "pressure set " << name_ << ", keyword body: there is no"
                << " body " << wanted << '.' << nl << "    Allowed: "
                << listed(names) << exit(FatalIOError);
        }
        moveToSurface(dict, 0.1*cloud.grid().cells().minSpacing());
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::pointField Foam::mpm::pressureSet::positions() const
{
    pointField positions(places_);
    if (body_)
    {
        for (point& x : positions) x = body_->motion().fromSurface(x);
    }
    return positions;
}


Foam::scalarList Foam::mpm::pressureSet::pressures
(
    const materialPointCloud& cloud
) const
{
    const lattice& cells = cloud.grid().cells();
    const label nDim = cells.nDim();
    const pointField x(positions());

    // Places that points of a cell may count for
    auto idOf = [&](const index3& cell)
    {
        int64_t id = 0;
        for (label d = 0; d < nDim; ++d)
        {
            const label n = cells.nCells(d);
            label i = cell[d];
            if (cells.periodic(d)) i = ((i % n) + n) % n;
            id = id*(int64_t(n) + 8) + i + 4;
        }
        return id;
    };
    std::unordered_map<int64_t, std::vector<label>> near;
    forAll(x, i)
    {
        index3 centre, o;
        centre = 0;
        o = 0;
        bool inside = true;
        for (label d = 0; d < nDim; ++d)
        {
            centre[d] = cells.cellCoordinate(d, x[i][cells.axis(d)]);
            inside = inside && centre[d] > -3 && centre[d] < cells.nCells(d) + 2;
        }
        if (!inside) continue;
        for (o[2] = (nDim == 3 ? -2 : 0); o[2] <= (nDim == 3 ? 2 : 0); ++o[2])
        for (o[1] = -2; o[1] <= 2; ++o[1])
        for (o[0] = -2; o[0] <= 2; ++o[0])
        {
            index3 cell;
            cell = 0;
            for (label d = 0; d < nDim; ++d) cell[d] = centre[d] + o[d];
            std::vector<label>& places = near[idOf(cell)];

            // Once, where a cyclic direction has less than five cells
            if (places.empty() || places.back() != i) places.push_back(i);
        }
    }

    scalarField p;
    cloud.visitFields(takePressure{p});

    // Points behind a thin plate know nothing of what is before it
    const std::vector<plate>& plates = cloud.grid().plates();
    auto parted = [&](const point& a, const point& b)
    {
        for (const plate& thin : plates)
        {
            const label ofA = thin.viewAt(a), ofB = thin.viewAt(b);
            if (ofA != plate::none && ofB != plate::none && ofA != ofB)
            {
                return true;
            }
        }
        return false;
    };

    // Sums of w, w dx, w dx dx, w p, w p dx, and the nearest point
    constexpr label nSums = 14;
    scalarList sums(nSums*x.size(), Zero);
    scalarList nearest(x.size(), GREAT);
    for (label k = 0; k < cloud.size(); ++k)
    {
        const point position(cloud.position(k));
        index3 cell;
        cell = 0;
        for (label d = 0; d < nDim; ++d)
        {
            cell[d] = cells.cellCoordinate(d, position[cells.axis(d)]);
        }
        const auto places = near.find(idOf(cell));
        if (places == near.end()) continue;
        for (const label i : places->second)
        {
            // In cells
            scalar dx[3] = {0, 0, 0};
            scalar rSqr = 0;
            for (label d = 0; d < nDim; ++d)
            {
                const label axis = cells.axis(d);
                dx[d] = (position[axis] - x[i][axis])/cells.spacing(d);
                if (cells.periodic(d))
                {
                    dx[d] -= cells.nCells(d)*std::round(dx[d]/cells.nCells(d));
                }
                rSqr += sqr(dx[d]);
            }
            const scalar r = std::sqrt(rSqr);
            if (parted(x[i], position)) continue;
            nearest[i] = min(nearest[i], r);
            if (!(r < radius)) continue;
            const scalar w = cloud.mass()[k]*sqr(1 - r/radius);
            scalar* s = sums.data() + nSums*i;
            s[0] += w;
            s[10] += w*p[k];
            label n = 4;
            for (label d = 0; d < 3; ++d)
            {
                s[1 + d] += w*dx[d];
                s[11 + d] += w*p[k]*dx[d];
                for (label e = d; e < 3; ++e) s[n++] += w*dx[d]*dx[e];
            }
        }
    }
    Pstream::listCombineGather(sums, plusEqOp<scalar>());
    Pstream::listCombineGather(nearest, minEqOp<scalar>());

    scalarList values(x.size(), Zero);
    forAll(x, i)
    {
        const scalar* s = sums.cdata() + nSums*i;
        if (!(s[0] > 0) || nearest[i] > wet) continue;

        // About the mean place of the points
        const vector mean(s[1]/s[0], s[2]/s[0], s[3]/s[0]);
        const scalar pMean = s[10]/s[0];
        symmTensor A
        (
            s[4]/s[0], s[5]/s[0], s[6]/s[0], s[7]/s[0], s[8]/s[0], s[9]/s[0]
        );
        A -= sqr(mean);
        vector b(s[11]/s[0], s[12]/s[0], s[13]/s[0]);
        b -= pMean*mean;
        if (nDim == 2) A.zz() = 1;

        // Points in a line have no gradient across it
        values[i] =
            det(A) > pow(1e-2, nDim) ? pMean - ((inv(A) & b) & mean) : pMean;
    }
    return values;
}

// ************************************************************************* //
