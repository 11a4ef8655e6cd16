/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "cellDecomposition.H"
#include "columnDecomposition.H"
#include "soilCloud.H"
#include "dictionaryEntries.H"
#include "labelIOList.H"
#include "listed.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::label Foam::mpm::cellDecomposition::column(const label celli) const
{
    const lattice& cells = system_.grid().cells();
    const label axis = cells.axis(along_);
    return label
    (
        (mesh_.C()[celli][axis] - mesh_.bounds().min()[axis])
       /cells.spacing(along_)
    );
}


Foam::label Foam::mpm::cellDecomposition::nRanks() const
{
    const IOdictionary dict
    (
        IOobject
        (
            "decomposeParDict",
            mesh_.time().system(),
            mesh_,
            IOobject::MUST_READ,
            IOobject::NO_WRITE,
            false
        )
    );
    const label n = readInteger(dict, "numberOfSubdomains", 1, 1000000);
    if (n > nColumns_)
    {
        FatalIOErrorInFunction(dict)
            << "keyword numberOfSubdomains is " << n << '.' << nl
            << "    Allowed for -decomposition: up to the number of cells in"
            << " the longest direction of the mesh, " << nColumns_
            << exit(FatalIOError);
    }
    return n;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::cellDecomposition::cellDecomposition
(
    const fvMesh& mesh,
    materialPointSystem& system
)
:
    mesh_(mesh),
    system_(system),
    along_(0)
{
    const lattice& cells = system.grid().cells();
    const vector span(mesh.bounds().span());
    for (label d = 1; d < cells.nDim(); ++d)
    {
        const scalar n = span[cells.axis(d)]/cells.spacing(d);
        const label a = cells.axis(along_);
        if (n > span[a]/cells.spacing(along_) + 0.5) along_ = d;
    }
    nColumns_ = label(span[cells.axis(along_)]/cells.spacing(along_) + 0.5);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::cellDecomposition::writeWeights(const scalar soilWeight) const
{
    volScalarField weights
    (
        IOobject("pointWeights", mesh_.time().timeName(), mesh_),
        mesh_,
        dimensionedScalar(dimless, Zero)
    );
    for (const materialPointCloud& cloud : system_.clouds())
    {
        const scalar weight = isA<soilCloud>(cloud) ? soilWeight : 1;
        for (label p = 0; p < cloud.size(); ++p)
        {
            weights[cloud.grid().meshCell(cloud.points().cell()[p])] += weight;
        }
        Info<< "Cloud " << cloud.name() << ": " << cloud.globalSize()
            << " points of weight " << weight << nl;
    }
    system_.writeOrStop([&] { return weights.write(); }, weights.objectPath());
    Info<< nl << "Written " << weights.name() << " to "
        << mesh_.time().timePath() << nl << nl << "End\n" << endl;
}


void Foam::mpm::cellDecomposition::writeRanks() const
{
    if (Pstream::parRun())
    {
        FatalErrorInFunction
            << "option -decomposition: the case is decomposed already." << nl
            << "    Allowed: in serial, before decomposePar"
            << exit(FatalError);
    }
    const label n = nRanks();
    const PtrList<materialPointCloud>& clouds = system_.clouds();

    List<scalarList> work(clouds.size());
    forAll(work, k)
    {
        const materialPointCloud& cloud = clouds[k];
        work[k].resize(nColumns_, Zero);
        for (label p = 0; p < cloud.size(); ++p)
        {
            ++work[k][column(cloud.grid().meshCell(cloud.points().cell()[p]))];
        }
    }

    const labelList rank(shareColumns(work, n));
    labelIOList cellRank
    (
        IOobject
        (
            "cellDecomposition",
            mesh_.facesInstance(),
            mesh_,
            IOobject::NO_READ,
            IOobject::NO_WRITE,
            false
        ),
        mesh_.nCells()
    );
    forAll(cellRank, celli) cellRank[celli] = rank[column(celli)];

    forAll(work, k)
    {
        scalarList ofRank(n, Zero);
        forAll(rank, c) ofRank[rank[c]] += work[k][c];
        Info<< "Cloud " << clouds[k].name() << ": points of the ranks "
            << listed(ofRank) << nl;
    }
    system_.writeOrStop
    (
        [&] { return cellRank.write(); }, cellRank.objectPath()
    );
    Info<< nl << "Written " << cellRank.objectPath() << nl << nl << "End\n"
        << endl;
}

// ************************************************************************* //
