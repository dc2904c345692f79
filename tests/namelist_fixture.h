/* namelist_fixture.h -- what the tests of namelists share. */
#ifndef NAMELIST_FIXTURE_H
#define NAMELIST_FIXTURE_H

#include "check.h"

#include <locale.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "deck/namelist/namelist.h"

/* The one value of the one name of the one group. */
static inline const namelist_value *only_value(const namelist *nl)
{
  assert_int_equal(nl->groups, 1);
  assert_int_equal(nl->assignments, 1);
  assert_int_equal(nl->values, 1);
  return &nl->value[0];
}

static const struct { const char *text, *tree; } good[] = {
  { "", "" },
  { "! nothing but a comment", "" },
  { "&g /", "g: /" },
  { "&g/", "g: /" },
  { "&g\n/\n", "g: /" },
  { "&g x=1 /", "g: x=1 /" },
  { "&g x=1", NULL },
  { "&G Xy_1 = A /", "g: xy_1=A /" },
  { "&a x=1 / &b y=2 /\n&c z=3/", "a: x=1 / b: y=2 / c: z=3 /" },
  { "$g x=1 $end", "g: x=1 /" },
  { "$g x=1 $END\n", "g: x=1 /" },
  { "&g x=1 &end", "g: x=1 /" },
  { "$g x=1 /", "g: x=1 /" },
  { "&g x=1 y=2, z=3,\n w=4 /", "g: x=1 y=2 z=3 w=4 /" },
  { "&g x = 1,2 , 3\n4 /", "g: x=1,2,3,4 /" },
  { "&g x = 1,,3 , , 5 /", "g: x=1,_,3,_,5 /" },
  { "&g x = ,1 /", "g: x=_,1 /" },
  { "&g x = 1, y=2 /", "g: x=1 y=2 /" },
  { "&g x = y=2 /", "g: x= y=2 /" },
  { "&g x = 3*1.5, 2* , 4*'a' 5*/", "g: x=3*1.5,2*_,4*'a',5*_ /" },
  { "&g x = 1*7 /", "g: x=7 /" },
  { "&g x(3)=1 y( 2 : 4 )=1 z(:)=1 u(2:)=1 w(1:9:2)=1 t(:5)=1 /",
    "g: x(3:3:1)=1 y(2:4:1)=1 z(1:0:1)=1 u(2:0:1)=1 w(1:9:2)=1 t(1:5:1)=1 /" },
  { "&g s='a b', \"c\" t='it''s' u=\"\"\"\" v='' /",
    "g: s='a b',\"c\" t='it''s' u=\"\"\"\" v='' /" },
  { "&g s='/ &end ! = , ;' /", "g: s='/ &end ! = , ;' /" },
  { "&g s='ab\ncd' x=1 /", "g: s='ab\ncd' x=1 /" },
  { "&g ! one\n x=1 ! two / &end 'three'\n ! four\n /! five", "g: x=1 /" },
  { "&g x=1!two\n,2 /", "g: x=1,2 /" },
  { "&g x=nan(1) y=inf z=(1, 2) /", "g: x=nan(1) y=inf z=(1, 2) /" },
  { "&g\tx\t=\t1\t/\t", "g: x=1 /" },
  { "&g\r\nx=1\r\n/\r\n", "g: x=1 /" },
  { "\xEF\xBB\xBF&g x=1 /", "g: x=1 /" },
  { "&g s='\xCE\xB3 = 0' /", "g: s='\xCE\xB3 = 0' /" },
  { "&g t = T f = F\n t2 = .true. /", "g: t=T f=F t2=.true. /" },
  { "&g x\n=\n1 /", "g: x=1 /" },
  { "&end_of_it x=1 /", "end_of_it: x=1 /" },
  { "&g x=R&D y=a$b /", "g: x=R&D y=a$b /" },
};

#endif
