; Two mugs stand on table1 where guests left them and are to go back to the counter.

(defproblem clear_table restaurant
  (
    ; the robot: somewhere on the floor, torso down, arms opened after start-up, hands empty
    (RobotAt floorareatamsrestaurant1)
    (HasTorsoPosture torsodownposture)
    (HasArmPosture leftarm1 armuntuckedposture) (HasArmPosture rightarm1 armuntuckedposture)
    (Holding leftarm1 nothing) (Holding rightarm1 nothing)

    ; guests
    (At guest1 sittingareawesttable1) (At guest2 sittingareaeasttable1)
    (At guest3 sittingareanorthtable2) (At guest4 sittingareasouthtable2)

    ; objects
    (Type mug mug1) (Type mug mug2)
    (On mug1 placingareawestrighttable1) (On mug2 placingareaeastrighttable1))

  ((clear_table table1 counter1)))
