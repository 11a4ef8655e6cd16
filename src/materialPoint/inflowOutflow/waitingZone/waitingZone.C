/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "waitingZone.H"
#include "stringList.H"
#include <algorithm>
#include <sstream>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

std::deque<Foam::mpm::waitingZone::waitingPoint>
Foam::mpm::waitingZone::synchronised() const
{
    List<scalarList> all(Pstream::nProcs());
    all[Pstream::myProcNo()] = recent_;
    Pstream::gatherList(all);
    Pstream::scatterList(all);

    struct arrival { scalar step, id, mass; };
    std::vector<arrival> arrivals;
    for (const scalarList& list : all)
    {
        for (label i = 0; i < list.size(); i += 3)
        {
            arrivals.push_back(arrival{list[i], list[i + 1], list[i + 2]});
        }
    }
    std::sort
    (
        arrivals.begin(),
        arrivals.end(),
        [](const arrival& a, const arrival& b)
        {
            return a.step < b.step || (a.step == b.step && a.id < b.id);
        }
    );

    std::deque<waitingPoint> queue(queue_);
    for (const arrival& a : arrivals)
    {
        queue.push_back(waitingPoint{a.id, a.mass});
    }
    return queue;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::waitingZone::arrive
(
    const label step,
    const scalar id,
    const scalar mass
)
{
    arrived_.add(mass);
    if (!recycle_) return;

    recent_.append(step);
    recent_.append(id);
    recent_.append(mass);
}


Foam::scalarList Foam::mpm::waitingZone::take(const label n)
{
    if (recycle_)
    {
        queue_ = synchronised();
        recent_.clear();
    }

    scalarList ids(n);
    label i = 0;
    for (; i < n && queue_.size(); ++i)
    {
        ids[i] = queue_.front().id;
        reused_.add(queue_.front().mass);
        queue_.pop_front();
    }
    for (; i < n; ++i) ids[i] = nextId_++;
    return ids;
}


Foam::mpm::massAccount Foam::mpm::waitingZone::waiting() const
{
    massAccount a(arrived_.global());
    a -= reused_;
    return a;
}


void Foam::mpm::waitingZone::read(const dictionary& dict)
{
    nextId_ = dict.get<scalar>("nextId");
    arrived_.read(dict, "arrived");

    // Of all ranks
    reused_.n = readCount(dict, "reused");
    reused_.mass = exactSum::fromText(dict.get<string>("reusedMassDigits"));

    queue_.clear();
    if (!recycle_) return;

    // Texts: numbers would be written in binary, which no dictionary reads
    const stringList queue(dict.get<stringList>("waitingPoints"));
    for (const string& text : queue)
    {
        std::istringstream is(text);
        waitingPoint p;
        is >> p.id >> p.mass;
        queue_.push_back(p);
    }
}


void Foam::mpm::waitingZone::write(dictionary& dict) const
{
    dict.set("nextId", nextId_);
    arrived_.write(dict, "arrived");
    dict.set("reused", reused_.n);
    dict.set("reusedMassDigits", reused_.mass.text());

    const std::deque<waitingPoint> queue(synchronised());
    stringList texts(queue.size());
    forAll(texts, i)
    {
        std::ostringstream os;
        os.precision(17);
        os << queue[i].id << ' ' << queue[i].mass;
        texts[i] = os.str();
    }
    dict.set("waitingPoints", texts);
}

// ************************************************************************* //
