! The damped, driven pendulum for AUTO-07p: see compare.auto.
!
! U = (y, v, s, c): angle, velocity, and an oscillator that goes to s = sin(omega t), c = cos(omega t),
! which makes the system autonomous. PAR(1..3) = damping, drive amplitude, drive frequency; PAR(6) = 1
! puts the force a1 y + a2 y^2 + a3 y^3, PAR(7..9) = a1, a2, a3, in the place of sin y; PAR(11) is the
! period. PAR(4), PAR(5): mean of y over the orbit, and the energy dissipated, which is the loop
! area.

SUBROUTINE FUNC(NDIM,U,ICP,PAR,IJAC,F,DFDU,DFDP)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM, ICP(*), IJAC
  DOUBLE PRECISION, INTENT(IN) :: U(NDIM), PAR(*)
  DOUBLE PRECISION, INTENT(OUT) :: F(NDIM)
  DOUBLE PRECISION, INTENT(INOUT) :: DFDU(NDIM,NDIM), DFDP(NDIM,*)
  DOUBLE PRECISION :: R2
  R2 = U(3)**2 + U(4)**2
  F(1) = U(2)
  F(2) = -(1 - PAR(6))*SIN(U(1)) - U(1)*(PAR(7) + U(1)*(PAR(8) + U(1)*PAR(9))) &
         - PAR(1)*U(2) + PAR(2)*U(4)
  F(3) =  U(3) + PAR(3)*U(4) - U(3)*R2
  F(4) = -PAR(3)*U(3) + U(4) - U(4)*R2
END SUBROUTINE FUNC

SUBROUTINE STPNT(NDIM,U,PAR,T)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM
  DOUBLE PRECISION, INTENT(INOUT) :: U(NDIM), PAR(*)
  DOUBLE PRECISION, INTENT(IN) :: T
  ! Orbits come from data files, parameters from the script.
END SUBROUTINE STPNT

SUBROUTINE BCND
END SUBROUTINE BCND

SUBROUTINE ICND
END SUBROUTINE ICND

SUBROUTINE FOPT
END SUBROUTINE FOPT

SUBROUTINE PVLS(NDIM,U,PAR)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM
  DOUBLE PRECISION, INTENT(IN) :: U(NDIM)
  DOUBLE PRECISION, INTENT(INOUT) :: PAR(*)
  DOUBLE PRECISION, EXTERNAL :: GETP
  PAR(4) = GETP('INT', 1, U)
  PAR(5) = PAR(1) * PAR(11) * GETP('NRM', 2, U)**2
END SUBROUTINE PVLS
