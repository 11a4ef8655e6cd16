/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "gridVolume.H"
#include "bitSet.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

template<class Op>
void Foam::mpm::gridVolume::forTile(const label cell, const Op& op) const
{
    const label stencil = cloud_.boundary().folding().stencil(cell);
    if (stencil < 0)
    {
        const label first = cell + grid_.reachOffset();
        for (label t = 0; t < grid_.reachSize(); ++t)
        {
            op(t, first + grid_.reachNode(t));
        }
    }
    else
    {
        const label* target = cloud_.boundary().folding().targets(stencil);
        for (label t = 0; t < grid_.reachSize(); ++t) op(t, target[t]);
    }
}


template<class Shape, int dim>
void Foam::mpm::gridVolume::sumVolumes(nodeField<scalar>& volume) const
{
    constexpr int T = Shape::reachWidth;
    const label* cell = cloud_.points().cell();

    for (label p = 0; p < cloud_.size();)
    {
        scalar tile[dim == 2 ? T*T : T*T*T] = {};
        const label runCell = cell[p];

        for (; p < cloud_.size() && cell[p] == runCell; ++p)
        {
            scalar w[dim][T], q[T], g[T];
            for (label d = 0; d < dim; ++d)
            {
                const scalar xi =
                    (cloud_.x(d)[p] - grid_.cells().origin(d))
                   /grid_.cells().spacing(d);
                Shape::reachWeights(xi - std::floor(xi), w[d], q, g);
            }

            const scalar V = cloud_.volume(p);
            for (int k = 0; k < (dim == 3 ? T : 1); ++k)
            for (int j = 0; j < T; ++j)
            {
                const scalar Vw = V*w[1][j]*(dim == 3 ? w[dim - 1][k] : 1);
                scalar* row = tile + T*(j + T*k);
                for (int i = 0; i < T; ++i) row[i] += Vw*w[0][i];
            }
        }

        forTile
        (
            runCell,
            [&](const label t, const label node) { volume[node] += tile[t]; }
        );
    }
}


template<class Shape>
void Foam::mpm::gridVolume::sumVolumes(nodeField<scalar>& volume) const
{
    if (grid_.nDim() == 2) sumVolumes<Shape, 2>(volume);
    else sumVolumes<Shape, 3>(volume);
}


Foam::mpm::nodeField<Foam::scalar> Foam::mpm::gridVolume::saturation() const
{
    nodeField<scalar> S(grid_.nNodes(), 0);

    const word& shape = grid_.shapeFunction();
    if (shape == linear::name) sumVolumes<linear>(S);
    else if (shape == quadraticBSpline::name) sumVolumes<quadraticBSpline>(S);
    else sumVolumes<cubicBSpline>(S);

    grid_.exchange().sum(S);

    const std::vector<scalar>& inverse = cloud_.boundary().inverseVolume();
    for (size_t i = 0; i < S.size(); ++i) S[i] *= inverse[i];
    return S;
}


void Foam::mpm::gridVolume::erode(std::vector<char>& flag) const
{
    // One direction after the other. The outermost nodes of the box, whose
    // neighbours do not exist, belong to no cell.
    std::vector<char> before;
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        before = flag;
        const size_t s = grid_.stride(d);
        for (size_t i = s; i + s < flag.size(); ++i)
        {
            flag[i] = before[i - s] & before[i] & before[i + s];
        }
    }
}


Foam::mpm::nodeField<Foam::scalar> Foam::mpm::gridVolume::inside
(
    const nodeField<scalar>& saturation
) const
{
    // Nodes behind walls have no control volume
    const std::vector<scalar>& inverse = cloud_.boundary().inverseVolume();
    std::vector<char> flag(saturation.size());
    for (size_t i = 0; i < flag.size(); ++i)
    {
        flag[i] = saturation[i] > 0.5 || inverse[i] == 0;
    }

    // As far as the shape function reaches
    erode(flag);
    if (grid_.shapeFunction() != linear::name) erode(flag);

    // The saturation of two layers around own cells is known on this rank
    nodeField<scalar> inside(flag.size(), 0);
    for (const label node : corners_) inside[node] = flag[node];
    grid_.exchange().sum(inside);
    for (scalar& i : inside) i = (i > 0 ? 1 : 0);
    return inside;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::gridVolume::gridVolume(const materialPointCloud& cloud)
:
    cloud_(cloud),
    grid_(cloud.grid()),
    ownVolume_(grid_.nNodes(), 0)
{
    const label T = grid_.reachWidth();
    bitSet corners(grid_.nNodes());

    for (label celli = 0; celli < grid_.mesh().nCells(); ++celli)
    {
        const label cell = grid_.boxCell(celli);
        forTile
        (
            cell,
            [&](const label t, const label node)
            {
                scalar v = grid_.cells().cellVolume()
                   *grid_.cellIntegral(t % T)*grid_.cellIntegral((t/T) % T);
                if (grid_.nDim() == 3) v *= grid_.cellIntegral(t/(T*T));
                ownVolume_[node] += v;
            }
        );
        for (label corner = 0; corner < (1 << grid_.nDim()); ++corner)
        {
            label node = cell;
            for (label d = 0; d < grid_.nDim(); ++d)
            {
                node += ((corner >> d) & 1)*grid_.stride(d);
            }
            corners.set(node);
        }
    }
    corners_ = corners.toc();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::gridVolume::sum() const
{
    const nodeField<scalar> S(saturation());
    const nodeField<scalar> in(inside(S));

    // Those behind, of thin plates, have no volume of their own
    scalar total = 0;
    for (label i = 0; i < grid_.nFirst(); ++i)
    {
        total += ownVolume_[i]*(in[i] > 0 ? 1 : S[i]);
    }
    return total;
}

// ************************************************************************* //
