/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include <iomanip>
#include <iostream>

namespace
{

template<class T>
void print
(
    const std::string& name,
    const T& value,
    const std::string& relation,
    const T& bound
)
{
    std::cout
        << "figure\t" << name << '\t' << std::setprecision(4) << value << '\t'
        << relation << '\t' << bound << std::endl;
}

} // End anonymous namespace


void atMost(const std::string& name, Foam::scalar value, Foam::scalar bound)
{
    print(name, value, "<=", bound);
    INFO(name);
    CHECK(value <= bound);
}


void atLeast(const std::string& name, Foam::scalar value, Foam::scalar bound)
{
    print(name, value, ">=", bound);
    INFO(name);
    CHECK(value >= bound);
}


void equal
(
    const std::string& name,
    const std::string& value,
    const std::string& expected
)
{
    print(name, value, "==", expected);
    INFO(name);
    CHECK(value == expected);
}


void equal(const std::string& name, Foam::label value, Foam::label expected)
{
    print(name, value, "==", expected);
    INFO(name);
    CHECK(value == expected);
}


void contains
(
    const std::string& message,
    const std::vector<std::string>& parts
)
{
    for (const std::string& part : parts)
    {
        INFO(message);
        print<std::string>
        (
            "the message names",
            message.find(part) != std::string::npos ? part : "nothing",
            "==",
            part
        );
        CHECK(message.find(part) != std::string::npos);
    }
}

// ************************************************************************* //
